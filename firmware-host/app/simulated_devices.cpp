// The world first, then its pictures, then the devices that measure it.
#include "firmware-host/app/simulated_devices.hpp"

#include "board/sim/movie_drawing.hpp"
#include "board/sim/ndi/simulated_byte_link.hpp"
#include "board/sim/simulated_frame_source.hpp"
#include "board/sim/simulated_gpio.hpp"
#include "board/sim/simulated_panel.hpp"

namespace orcart {
namespace {

constexpr Nanos kTrackerStart = 3s;  // probe, baud change, upload of two tools: under this at any baud
constexpr Nanos kDeviceLatencyFloor = 1ms;

std::vector<Instant> picture_instants(Instant start, Instant end, std::size_t count) {
  std::vector<Instant> instants;
  for (std::size_t i = 1; i <= count; ++i) {
    instants.push_back(
        start + (end - start) * static_cast<std::int64_t>(i) / static_cast<std::int64_t>(count) - 400ms);
  }
  return instants;
}

NdiEmulatorSettings emulator_settings(const CartConfig& config, Instant now) {
  NdiEmulatorSettings settings;
  settings.frame_rate_hz = config.tracker.rate_hz;
  settings.device_latency =
      std::max<Nanos>(kDeviceLatencyFloor, from_seconds(config.tracker.latency_ms * 1e-3));
  settings.noise = {.sigma_mm = config.simulation.marker_noise_mm, .seed = config.simulation.seed};
  settings.on_at = now;
  return settings;
}

std::vector<PedalEdge> edges_of(const SimulatedWorld& world, const std::vector<Nanos>& more_presses) {
  constexpr Nanos kPressLength = 110ms;
  std::vector<PedalEdge> edges = world.pedal_edges();
  for (const Nanos press : more_presses) {
    edges.push_back({.at = world.start() + press, .kind = EdgeKind::pressed});
    edges.push_back({.at = world.start() + press + kPressLength, .kind = EdgeKind::released});
  }
  return edges;
}

/// What the camera will see, unless it lies there already.
Result<MovieFile> draw_movie(const SimulatedDevices::Request& request, const RayScene& rays,
                             const SimulatedWorld& world) {
  const CartConfig& config = request.config;
  const SimulationConfig& simulation = config.simulation;
  const Effect effects = simulation.picture_noise ? Effect::on : Effect::off;
  SceneLook look{.specular = effects, .noise = effects, .blur = effects};
  if (config.seen_from == SeenFrom::outside) look.tissue = LivingTissue{.kind = TissueKind::cortex};
  const MovieRequest wanted{.surface = request.patient.surface,
                            .rays = rays,
                            .scope = request.patient.scope,
                            .world = world,
                            .look = look,
                            .format = config.camera.format,
                            .timing = {.rate_hz = config.camera.rate_hz,
                                       .exposure = from_seconds(config.camera.exposure_ms * 1e-3)}};
  std::error_code error;
  std::filesystem::create_directories(simulation.movie, error);
  char name[64];
  std::snprintf(name, sizeof name, "%016llx.orcmovie",
                static_cast<unsigned long long>(header_for(wanted).content));
  return movie_for(simulation.movie / name, wanted, [&](std::uint64_t drawn, std::uint64_t all) {
    if (request.drawing) request.drawing(static_cast<double>(drawn) / static_cast<double>(all));
  });
}

}  // namespace

struct SimulatedDevices::State {
  SimulatedWorld world;
  std::optional<MovieFile> movie;  ///< nothing where the camera is real
  NdiEmulator emulator;
  SimulatedByteLink link;
  std::optional<SimulatedFrameSource> camera;
  SimulatedGpio pedal;
  std::optional<SimulatedEncoder> encoder;  ///< where the turn is followed by one
  PanelPictures pictures;
  std::vector<PanelObserver*> observers;
  SimulatedPanel panel;
  ByteLink* real_tracker;
  FrameSource* real_camera;
  GpioLines* real_pedal;
  TurnEncoder* real_encoder;

  State(SimulatedWorld made_world, std::optional<MovieFile> made_movie, const Request& request)
      : world(std::move(made_world)),
        movie(std::move(made_movie)),
        emulator(emulator_settings(request.config, request.clock.now()), world),
        link(emulator, request.clock),
        pedal(request.clock, {.edges = edges_of(world, request.more_presses), .bounce = {.pairs = 2}}),
        pictures(mode_of(request.config), picture_instants(world.start(), world.end(), request.pictures)),
        observers(observers_of(pictures, request.preview)),
        panel(request.clock, {.mode = mode_of(request.config), .first_vblank = request.clock.now() + 7ms},
              observers),
        real_tracker(request.tracker),
        real_camera(request.camera),
        real_pedal(request.real_pedal),
        real_encoder(request.real_encoder) {
    if (request.config.turn == TurnSource::encoder)
      encoder.emplace(request.clock,
                      encoder_script(world, static_cast<double>(request.config.encoder.counts_per_turn),
                                     request.encoder_faults));
    if (!movie) return;
    camera.emplace(
        request.clock, *movie,
        SimulatedCameraSetup{.start = world.start(),
                             .stamp_at = request.config.camera.stamp == StampMeaning::start_of_exposure
                                             ? StampAt::exposure_start
                                             : StampAt::exposure_end,
                             .buffers = kFrameBuffers,
                             .faults = request.camera_faults});
  }

  static std::vector<PanelObserver*> observers_of(PanelPictures& kept, PanelObserver* preview) {
    if (preview == nullptr) return {&kept};
    return {&kept, preview};
  }
  static PanelMode mode_of(const CartConfig& config) {
    return {.width_px = config.panel.width_px,
            .height_px = config.panel.height_px,
            .refresh_hz = config.panel.refresh_hz};
  }
};

Result<std::unique_ptr<SimulatedDevices>> SimulatedDevices::create(const Request& request) {
  const CartConfig& config = request.config;
  const SimulationConfig& simulation = config.simulation;
  auto rays = RayScene::create(request.patient.surface.mesh);
  if (!rays) return tl::unexpected(rays.error());
  ProcedureScript script = request.script;
  script.seed = simulation.seed;
  script.duration_s = simulation.duration_s;
  script.seen_from = config.seen_from;
  script.turn_rad = simulation.turn_rad;
  script.turn_every_s = simulation.turn_every_s;
  script.entry_direction = {simulation.entry_direction[0], simulation.entry_direction[1],
                            simulation.entry_direction[2]};
  auto world = SimulatedWorld::create(
      {.surface = request.patient.surface, .rays = *rays, .scope = request.patient.scope, .script = script});
  if (!world) return tl::unexpected(world.error());

  std::optional<MovieFile> movie;
  if (request.camera == nullptr) {
    auto drawn = draw_movie(request, *rays, *world);
    if (!drawn) return tl::unexpected(drawn.error());
    movie.emplace(std::move(*drawn));
  }
  world->put_reference(request.patient.registration.X_MR);
  world->begin_at(request.clock.now() + kTrackerStart);
  return std::unique_ptr<SimulatedDevices>(
      new SimulatedDevices(std::make_unique<State>(std::move(*world), std::move(movie), request)));
}

SimulatedDevices::SimulatedDevices(std::unique_ptr<State> state) : state_(std::move(state)) {}
SimulatedDevices::~SimulatedDevices() = default;

Ports SimulatedDevices::ports() {
  State& s = *state_;
  return {.tracker = s.real_tracker != nullptr ? *s.real_tracker : s.link,
          .camera = s.real_camera != nullptr ? *s.real_camera : *s.camera,
          .pedal = s.real_pedal != nullptr ? *s.real_pedal : s.pedal,
          .panel = s.panel,
          .encoder = s.real_encoder != nullptr ? s.real_encoder
                     : s.encoder               ? &*s.encoder
                                               : nullptr};
}
Instant SimulatedDevices::start() const {
  return state_->world.start();
}
Instant SimulatedDevices::end() const {
  return state_->world.end();
}
const SimulatedWorld& SimulatedDevices::world() const {
  return state_->world;
}
const PanelPictures& SimulatedDevices::pictures() const {
  return state_->pictures;
}
NdiFaultSchedule& SimulatedDevices::tracker_faults() {
  return state_->emulator.faults();
}

}  // namespace orcart
