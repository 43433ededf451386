// The operating room that plays itself to real drivers: pictures into v4l2loopback, presses into gpio-sim,
// NDI bytes into the far end of the USB bridge. All three come from one truth and one clock.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

#include "board/linux/file_descriptor.hpp"
#include "board/sim/movie_drawing.hpp"
#include "board/sim/ndi/ndi_emulator.hpp"
#include "board/sim/simulated_frame_source.hpp"
#include "board/sim/simulated_world.hpp"
#include "firmware-host/app/cart_config.hpp"
#include "firmware-host/app/patient.hpp"
#include "tests/board/linux/v4l2/loopback_writer.hpp"

namespace orcart::testing {

constexpr const char* kRoomMovie = "room-36s.orcmovie";

/// The demo, shorter, with fewer pictures a second than a software renderer in a software machine can show.
inline Result<CartConfig> room_config(const std::filesystem::path& source,
                                      const std::filesystem::path& binary) {
  auto config = read_cart(source / "share/carts/demo.toml");
  if (!config) return config;
  config->simulation.duration_s = 36;
  config->simulation.movie = binary / "vm/movies";
  config->texel_mm = 0.3;
  config->camera.rate_hz = 10;
  config->camera.stamp = StampMeaning::dequeued;  // v4l2loopback's stamps are of no known clock
  config->panel = {.width_px = 640, .height_px = 480, .refresh_hz = 10};
  config->tracker.baud = 921'600;  // the emulated bridge does not take a line's time
  return config;
}

/// Where the devices' other sides are.
struct RoomDoors {
  std::string camera;  ///< v4l2loopback's node
  std::string pedal;   ///< gpio-sim's file `pull`
  std::string bridge;  ///< the far end of the USB bridge
};

/// The tools as the procedure moves them, from an instant that is told while the tracker answers already.
class MotionFrom final : public ToolMotion {
 public:
  explicit MotionFrom(const SimulatedWorld& world) : world_(world) {}
  void begin_at(Instant start) noexcept { start_.store(nanos_since_zero(start), std::memory_order_relaxed); }
  Instant start() const noexcept { return instant_from_nanos(start_.load(std::memory_order_relaxed)); }
  /// In the world's own time, which begins at zero; there it rests until it was told.
  Instant world_time(Instant at) const noexcept {
    const Instant start = this->start();
    return Instant{} + (at > start ? at - start : Nanos{0});
  }
  TrueToolPose pose_of(int tool, Instant at) const noexcept override {
    return world_.pose_of(tool, world_time(at));
  }

 private:
  const SimulatedWorld& world_;
  std::atomic<std::int64_t> start_{nanos_since_zero(Instant::max())};
};

class Room {
 public:
  /// Plans the procedure; draws its pictures unless they lie there already.
  static Result<std::unique_ptr<Room>> create(const CartConfig& config, const Patient& patient) {
    auto rays = RayScene::create(patient.surface.mesh);
    if (!rays) return tl::unexpected(rays.error());
    ProcedureScript script{.seed = config.simulation.seed,
                           .duration_s = config.simulation.duration_s,
                           .seen_from = config.seen_from,
                           .press_every_s = 2.5,
                           .rest_s = 1.2};
    const auto& entry = config.simulation.entry_direction;
    script.entry_direction = {entry[0], entry[1], entry[2]};
    script.hide_at = script.stream_at = script.undo_at = -1;
    auto world = SimulatedWorld::create(
        {.surface = patient.surface, .rays = *rays, .scope = patient.scope, .script = script});
    if (!world) return tl::unexpected(world.error());
    std::filesystem::create_directories(config.simulation.movie);
    auto movie = movie_for(config.simulation.movie / kRoomMovie,
                           {.surface = patient.surface,
                            .rays = *rays,
                            .scope = patient.scope,
                            .world = *world,
                            .format = config.camera.format,
                            .timing = {.rate_hz = config.camera.rate_hz,
                                       .exposure = from_seconds(config.camera.exposure_ms * 1e-3)}});
    if (!movie) return tl::unexpected(movie.error());
    world->put_reference(patient.registration.X_MR);
    return std::unique_ptr<Room>(new Room(config, std::move(*world), std::move(*movie)));
  }
  ~Room() {
    over_.store(true, std::memory_order_relaxed);
    for (std::thread& actor : actors_) actor.join();
  }

  Nanos duration() const { return world_.end() - world_.start(); }
  std::size_t presses() const { return world_.pedal_edges().size() / 2; }
  /// Where the camera truly was.
  Pose<M, C> X_MC(Instant at) const { return world_.X_MC(motion_.world_time(at)); }

  /// The camera has its format before anybody opens it, and the tracker answers; the procedure begins later.
  Result<void> open(const RoomDoors& doors, Clock& clock) {
    doors_ = doors;
    if (auto opened = camera_.open(doors.camera, config_.camera.width_px, config_.camera.height_px); !opened)
      return opened;
    bridge_ = FileDescriptor(::open(doors.bridge.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!bridge_.valid()) return fail(doors.bridge + " cannot be opened");
    NdiEmulatorSettings settings{.frame_rate_hz = config_.tracker.rate_hz, .has_line = false};
    settings.device_latency = from_seconds(config_.tracker.latency_ms * 1e-3);
    settings.noise = {.sigma_mm = config_.simulation.marker_noise_mm, .seed = 1};
    settings.on_at = clock.now();
    tracker_ = std::make_unique<NdiEmulator>(settings, motion_);
    actors_.emplace_back([this] { play_tracker(); });
    return {};
  }
  /// Whether somebody has brought the tracker to tracking.
  bool is_tracking() const { return is_tracking_.load(std::memory_order_relaxed); }
  /// After open().
  void begin_at(Instant start) {
    motion_.begin_at(start);
    actors_.emplace_back([this] { play_camera(); });
    actors_.emplace_back([this] { play_pedal(); });
  }
  std::uint64_t pictures_shown() const { return pictures_shown_.load(std::memory_order_relaxed); }

 private:
  Room(const CartConfig& config, SimulatedWorld world, MovieFile movie)
      : config_(config), world_(std::move(world)), movie_(std::move(movie)) {}
  bool over() const { return over_.load(std::memory_order_relaxed); }

  void play_tracker() {
    RealClock clock;
    std::array<std::byte, 4096> buffer{};
    while (!over()) {
      const Nanos until_reply = std::clamp<Nanos>(tracker_->next_event() - clock.now(), 0ms, 5ms);
      const timespec timeout{.tv_sec = 0, .tv_nsec = until_reply.count()};
      pollfd watched{.fd = bridge_.get(), .events = POLLIN, .revents = 0};
      ::ppoll(&watched, 1, &timeout, nullptr);
      const ssize_t got = ::read(bridge_.get(), buffer.data(), buffer.size());
      if (got > 0) tracker_->receive(std::span{buffer}.first(static_cast<std::size_t>(got)), clock.now());
      while (const std::size_t count = tracker_->read(buffer, clock.now()))
        (void)!::write(bridge_.get(), buffer.data(), count);
      is_tracking_.store(tracker_->tracking(), std::memory_order_relaxed);
      // Nobody holds the other end: a port without a reader hangs up at once.
      if ((watched.revents & POLLHUP) != 0) clock.sleep_until(clock.now() + 2ms);
    }
  }
  void play_camera() {
    RealClock clock;
    SimulatedFrameSource frames(clock, movie_, {.start = motion_.start()});
    (void)frames.start();
    while (!over()) {
      frames.wait(clock.now() + 20ms);
      const auto frame = frames.take();
      if (!frame) continue;
      if (camera_.write(frame->image.planes[0].data)) pictures_shown_.fetch_add(1, std::memory_order_relaxed);
      frames.give_back(frame->index);
    }
  }
  void play_pedal() {
    RealClock clock;
    for (const PedalEdge& edge : world_.pedal_edges()) {
      const Instant at = motion_.start() + (edge.at - world_.start());
      while (!over() && clock.now() < at) clock.sleep_until(std::min(at, clock.now() + 50ms));
      if (over()) return;
      std::ofstream(doors_.pedal) << (edge.kind == EdgeKind::pressed ? "pull-up" : "pull-down") << std::flush;
    }
  }

  CartConfig config_;
  SimulatedWorld world_;
  MotionFrom motion_{world_};
  MovieFile movie_;
  RoomDoors doors_;
  LoopbackWriter camera_;
  FileDescriptor bridge_;
  std::unique_ptr<NdiEmulator> tracker_;
  std::vector<std::thread> actors_;
  std::atomic<bool> over_{false}, is_tracking_{false};
  std::atomic<std::uint64_t> pictures_shown_{0};
};

}  // namespace orcart::testing
