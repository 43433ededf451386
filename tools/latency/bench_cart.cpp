// World, emulated devices and cart; the pictures are a few of noise, over and over.
#include "tools/latency/bench_cart.hpp"

#include <optional>
#include <random>

#include "board/sim/picture_supply.hpp"
#include "firmware-host/app/patient.hpp"
#include "realtime/geometry/ray_scene.hpp"

namespace orcart {
namespace {

MemoryPictures noise_pictures(const CartConfig& config) {
  const CameraConfig& camera = config.camera;
  std::mt19937 random(1);
  std::vector<std::vector<std::byte>> pictures;
  for (int i = 0; i < 3; ++i) {
    auto& picture = pictures.emplace_back(packed_bytes(camera.format, camera.width_px, camera.height_px));
    for (std::byte& pixel : picture) pixel = static_cast<std::byte>(random());
  }
  const FrameFormat format{.width_px = camera.width_px,
                           .height_px = camera.height_px,
                           .format = camera.format,
                           .rate_hz = camera.rate_hz};
  return {format,
          {.rate_hz = camera.rate_hz, .exposure = from_seconds(camera.exposure_ms * 1e-3)},
          1'000'000'000,
          std::move(pictures)};
}

std::vector<PedalEdge> presses(Instant from, Instant until) {
  constexpr Nanos kPressLength = 110ms;
  std::vector<PedalEdge> edges;
  for (Instant at = from + 300ms; at < until - BenchCart::kPressEvery; at += BenchCart::kPressEvery) {
    edges.push_back({.at = at, .kind = EdgeKind::pressed});
    edges.push_back({.at = at + kPressLength, .kind = EdgeKind::released});
  }
  return edges;
}

Result<SimulatedWorld> world_of(const CartConfig& config, const Patient& patient, double duration_s) {
  auto rays = RayScene::create(patient.surface.mesh);
  if (!rays) return tl::unexpected(rays.error());
  const auto& entry = config.simulation.entry_direction;
  ProcedureScript script{.seed = config.simulation.seed,
                         .duration_s = duration_s,
                         .seen_from = config.seen_from,
                         .entry_direction = {entry[0], entry[1], entry[2]},
                         .undo_at = -1,
                         .stream_at = -1,
                         .hide_at = -1,
                         .turn_rad = config.simulation.turn_rad,
                         .turn_every_s = config.simulation.turn_every_s};
  return SimulatedWorld::create(
      {.surface = patient.surface, .rays = *rays, .scope = patient.scope, .script = script});
}

}  // namespace

struct BenchCart::State {
  State(BenchCartWish asked, Patient of, SimulatedWorld made)
      : wish(std::move(asked)),
        patient(std::move(of)),
        world(std::move(made)),
        pictures(noise_pictures(wish.config)),
        emulator({.frame_rate_hz = wish.config.tracker.rate_hz,
                  .device_latency = std::max<Nanos>(1ms, from_seconds(wish.config.tracker.latency_ms * 1e-3)),
                  .noise = {.sigma_mm = wish.config.simulation.marker_noise_mm, .seed = 1},
                  .on_at = clock.now()},
                 world),
        link(emulator, clock),
        panel(clock, {.mode = {.width_px = wish.config.panel.width_px,
                               .height_px = wish.config.panel.height_px,
                               .refresh_hz = wish.config.panel.refresh_hz},
                      .first_vblank = clock.now() + 7ms}) {
    world.put_reference(patient.registration.X_MR);
    schedule();
  }

  /// Counts everything from now on. Once for the cart to be built on, and again when it is: nobody knows how
  /// long that takes on a busy machine. Camera and pedal are made anew in their places, which the cart only
  /// refers to.
  void schedule() {
    begin = clock.now() + kTrackerStart;
    end = begin + kWarmUp + from_seconds(wish.duration_s);
    world.begin_at(begin);
    const StampAt stamp_at = wish.config.camera.stamp == StampMeaning::start_of_exposure
                                 ? StampAt::exposure_start
                                 : StampAt::exposure_end;
    camera.emplace(clock, pictures,
                   SimulatedCameraSetup{.start = begin, .stamp_at = stamp_at, .buffers = kFrameBuffers});
    pedal.emplace(clock, GpioScript{.edges = presses(begin, end), .lost = wish.lost_edges});
  }

  BenchCartWish wish;
  Patient patient;
  SimulatedWorld world;
  MemoryPictures pictures;
  RealClock clock;
  Instant begin{}, end{};
  NdiEmulator emulator;
  SimulatedByteLink link;
  std::optional<SimulatedFrameSource> camera;
  std::optional<SimulatedGpio> pedal;
  SimulatedPanel panel;
  std::unique_ptr<Cart> cart;
};

Result<std::unique_ptr<BenchCart>> BenchCart::create(BenchCartWish wish) {
  auto patient = read_patient(wish.config);
  if (!patient) return tl::unexpected(patient.error());
  auto world = world_of(wish.config, *patient, wish.duration_s + seconds(kWarmUp));
  if (!world) return tl::unexpected(world.error());
  auto state = std::make_unique<State>(std::move(wish), std::move(*patient), std::move(*world));
  State& s = *state;
  auto cart =
      Cart::create({.config = s.wish.config,
                    .patient = s.patient,
                    .ports = {.tracker = s.link, .camera = *s.camera, .pedal = *s.pedal, .panel = s.panel},
                    .clock = s.clock,
                    .longest_run_s = s.wish.duration_s + 10,
                    .wrapper = s.wish.wrapper,
                    .traced = s.wish.traced});
  if (!cart) return tl::unexpected(cart.error());
  s.cart = std::move(*cart);
  return std::unique_ptr<BenchCart>(new BenchCart(std::move(state)));
}

BenchCart::BenchCart(std::unique_ptr<State> state) : state_(std::move(state)) {}
BenchCart::~BenchCart() = default;

Result<void> BenchCart::run(const std::function<void()>& warm, const std::function<void(double)>& tick) {
  State& s = *state_;
  s.schedule();
  if (auto started = s.cart->start(); !started) return started;
  s.clock.sleep_until(measured_from());
  if (warm) warm();
  for (Instant now = s.clock.now(); now < s.end; now = s.clock.now()) {
    if (tick) tick(seconds(now - measured_from()) / s.wish.duration_s);
    s.clock.sleep_until(std::min(s.end, now + 100ms));
  }
  s.cart->stop();
  return {};
}

Cart& BenchCart::cart() {
  return *state_->cart;
}
const CartConfig& BenchCart::config() const {
  return state_->wish.config;
}
Instant BenchCart::measured_from() const {
  return state_->begin + kWarmUp;
}

}  // namespace orcart
