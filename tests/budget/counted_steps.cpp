// Runs each step at its worst case for callgrind to count: one dump a step, named by it.
#include <hwy/nanobenchmark.h>

#include <cmath>

#include "board/sim/picture_supply.hpp"
#include "board/sim/simulated_frame_source.hpp"
#include "board/sim/simulated_gpio.hpp"
#include "firmware-host/app/topology.hpp"
#include "firmware-host/stages/camera_stage.hpp"
#include "firmware-host/stages/mapper_stage.hpp"
#include "firmware-host/stages/pedal_stage.hpp"
#include "firmware-host/stages/sync_stage.hpp"
#include "firmware-host/stages/tracker_stage.hpp"
#include "realtime/mapper/cutout.hpp"
#include "tests/budget/counted.hpp"
#include "tests/firmware-host/tracker/tracker_rig.hpp"
#include "tests/realtime/mapper/mapper_fixture.hpp"
#include "tests/realtime/sync/sync_samples.hpp"

namespace orcart::testing {
namespace {

std::unique_ptr<Lanes> lanes_of_the_cart() {
  return std::make_unique<Lanes>(LaneDepths{.poses = kPoseQueueDepth,
                                            .pedal = kPedalQueueDepth,
                                            .frames = kFrameQueueDepth,
                                            .orders = kPaintQueueDepth,
                                            .patches = kPatchSlots});
}

/// As many edges as one step takes, each with its bounce a millisecond apart.
void pedal(int edges) {
  SimulatedClock clock;
  GpioScript script;
  for (int i = 0; i < edges; ++i)
    script.edges.push_back(
        {.at = clock.now() + Nanos{1ms} * i, .kind = i % 2 == 0 ? EdgeKind::pressed : EdgeKind::released});
  SimulatedGpio line(clock, script);
  auto lanes = lanes_of_the_cart();
  PedalStage stage(line, {}, *lanes);
  clock.advance_by(100ms);
  count("pedal", edges, [&] { (void)stage.step(clock.now()); });
}

/// A line whose far side is not counted.
class Uncounted final : public ByteLink {
 public:
  explicit Uncounted(ByteLink& link) : link_(link) {}
  void counting(bool now) { counting_ = now; }
  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept override {
    const Pause pause(counting_);
    return link_.write(bytes);
  }
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept override {
    const Pause pause(counting_);
    return link_.read(into);
  }
  Instant last_arrival() const noexcept override { return link_.last_arrival(); }
  void discard_input() noexcept override {
    const Pause pause(counting_);
    link_.discard_input();
  }
  Result<void, PortFault> set_line(const LineSettings& line) noexcept override {
    return link_.set_line(line);
  }
  Result<void, PortFault> send_break() noexcept override { return link_.send_break(); }
  Result<void, PortFault> reopen() noexcept override { return link_.reopen(); }
  void wait(Instant deadline) noexcept override {
    const Pause pause(counting_);
    link_.wait(deadline);
  }
  Instant next_event() const noexcept override { return link_.next_event(); }

 private:
  class Pause {
   public:
    explicit Pause(bool counting) : counting_(counting) {
      if (counting_) CALLGRIND_TOGGLE_COLLECT;
    }
    ~Pause() {
      if (counting_) CALLGRIND_TOGGLE_COLLECT;
    }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    bool counting_;
  };
  ByteLink& link_;
  bool counting_ = false;
};

/// Polls of two tools and their replies, as long as they get.
void tracker(int polls) {
  CirclingTools motion;
  SimulatedClock clock;
  NdiEmulator device({}, motion);
  SimulatedByteLink wire(device, clock);
  Uncounted link(wire);
  NdiDriver driver(two_tools(), link);
  auto lanes = lanes_of_the_cart();
  TrackerStage stage(driver, {}, *lanes);
  const auto run_until_poll = [&](std::uint64_t last) {
    while (driver.counters().replies < last && clock.now() < instant_from_nanos(0) + 3600s) {
      link.wait(std::min(driver.next_due(), clock.now() + 1s));
      (void)stage.step(clock.now());
      for (PoseSample sample; lanes->poses.try_pop(sample);) {
      }
    }
  };
  run_until_poll(1000);  // the clock's fit is full
  link.counting(true);
  count("tracker", polls, [&] { run_until_poll(1000 + static_cast<std::uint64_t>(polls)); });
}

/// Pictures of 640 x 480 with a scope's circle and notch.
void notch(int pictures) {
  ScopeModel scope{.width_px = 640, .height_px = 480};
  scope.lens = {.fx_px = 340, .fy_px = 340, .cx_px = 321, .cy_px = 239};
  scope.mask = {.cx_px = 321, .cy_px = 239, .radius_px = 210};
  scope.notch_rad = 0.4;
  scope.turning = Turning{.centre_px = {317, 243}};
  std::vector<std::byte> grey;
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const double radius = std::hypot(x - 321, y - 239) / 210, angle = std::atan2(y - 239, x - 321);
      const bool tooth = radius > 0.91 && std::abs(angle - 0.4) < 0.05;
      grey.push_back(std::byte(radius < 1 && !tooth ? 120 : 16));
    }
  NotchSearch search(scope);
  const auto image = packed_image(grey.data(), PixelFormat::gray8, 640, 480);
  (void)search.turn_in(image);
  count("notch", pictures, [&] {
    for (int i = 0; i < pictures; ++i) (void)search.turn_in(image);
  });
}

/// As many frames as there are buffers.
void camera(int frames) {
  SimulatedClock clock;
  const ExposureTiming timing{.rate_hz = 100, .exposure = 1ms, .first = 1ms};
  const MemoryPictures pictures(
      {.width_px = 64, .height_px = 48, .format = PixelFormat::yuyv, .rate_hz = 100}, timing, 1000,
      {std::vector<std::byte>(64 * 48 * 2)});
  SimulatedFrameSource source(clock, pictures,
                              {.start = clock.now(), .readout = 0ms, .buffers = kFrameBuffers});
  auto lanes = lanes_of_the_cart();
  CameraStage stage(source, clock, {.exposure = 1ms}, *lanes);
  (void)source.start();
  source.wait(clock.now() + 1ns);
  clock.advance_by(3ms);  // a first one, which nothing is compared with
  (void)stage.step(clock.now());
  for (CapturedFrame first; lanes->frames.try_pop(first);) (void)lanes->frames_home.try_push(first.buffer);
  (void)stage.step(clock.now());
  clock.advance_by(10ms * frames);
  count("camera", frames, [&] { (void)stage.step(clock.now()); });
}

/// A mapping thread that was held up: full queues of poses, the frames of all buffers, and a press for each.
void match(int poses) {
  auto lanes = lanes_of_the_cart();
  SyncStage stage({.history = {.period = 16ms}, .matcher = {}, .selector = {}}, *lanes);
  for (int i = 0; i < 128; ++i) {  // a history that is full already
    (void)lanes->poses.try_push(sample_at(at_ms(16.0 * i)));
    (void)stage.step(at_ms(16.0 * i + 10));
  }
  const double base = 16.0 * 128;
  for (int i = 0; i < poses; ++i) (void)lanes->poses.try_push(sample_at(at_ms(base + 16.0 * i)));
  for (int i = 0; i < poses * static_cast<int>(kFrameBuffers) / 64; ++i) {
    (void)lanes->frames.try_push(frame_at(at_ms(base + 5 + 33.0 * i), static_cast<std::uint32_t>(i)));
    (void)lanes->pedal.try_push({.kind = PedalEventKind::capture,
                                 .unit = static_cast<std::uint32_t>(i) + 1,
                                 .at = at_ms(base + 33.0 * i)});
  }
  count("match", poses, [&] { (void)stage.step(at_ms(base + 16.0 * 64 + 10)); });
}

/// A wall all of which lies in the cone, of 2 * cells^2 triangles (cells x cells / 2 for the half).
void mapper(int rows) {
  TriangleMesh wall = plane_grid(12, 100, 40);
  wall.triangles.resize(static_cast<std::size_t>(rows) * 200);
  const Surface surface = surface_of(std::move(wall));
  const MapperLimits limits;
  auto made = Mapper::create(surface, SeenFrom::outside, pinhole_scope(), limits);
  if (!made) return;
  CutoutPatch patch(patch_capacity(limits));
  made->begin({}, TextureMode::perspective);
  while (made->next(patch)) {
  }
  count("mapper", rows * 200, [&] {
    made->begin({}, TextureMode::perspective);
    while (made->next(patch)) {
    }
  });
}

/// The cutout's forms, from within a ball of 20,480 triangles towards all sides: about 1,500 in a view.
void cutouts(int views) {
  const TriangleMesh ball = icosphere(30, 5);
  const auto tree = ClusterTree::create(ball);
  const auto rays = RayScene::create(ball);
  if (!tree || !rays) return;
  Cutout cutout(*tree, *rays, pinhole_scope());
  CutoutMesh mesh(ball.triangles.size());
  CutoutRanges ranges(tree->cluster_count());
  const auto each_view = [&](auto&& cut) {
    for (int i = 0; i < views; ++i) {
      const double turn = 2.4 * (i % 25), height = (i % 25 - 12) / 12.5;  // twice the same: twice the work
      const Eigen::Vector3d along(std::cos(turn) * std::sqrt(1 - height * height),
                                  std::sin(turn) * std::sqrt(1 - height * height), height);
      cut(looking(-10 * along, 30 * along));
    }
  };
  const auto emit = [&](CutoutForm form) {
    each_view([&](const Pose<M, C>& X_MC) {
      cutout.begin(X_MC, form);
      while (cutout.next(mesh)) {
      }
    });
  };
  emit(CutoutForm::clip);  // Embree and the dispatch have been used
  count("cutout", views, [&] { emit(CutoutForm::whole); });
  count("clip", views, [&] { emit(CutoutForm::clip); });
  count("ranges", views, [&] { each_view([&](const Pose<M, C>& X_MC) { cutout.ranges(X_MC, ranges); }); });
}

}  // namespace
}  // namespace orcart::testing

int main() {
  using namespace orcart::testing;
  if (!pin_to_avx2()) return kNoAvx2;
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_START_INSTRUMENTATION;
  for (const int edges : {16, 32}) pedal(edges);
  for (const int polls : {50, 100}) tracker(polls);
  for (const int frames : {5, 10}) camera(frames);
  for (const int pictures : {5, 10}) notch(pictures);
  for (const int poses : {32, 64}) match(poses);
  for (const int rows : {20, 40}) mapper(rows);
  for (const int views : {25, 50}) cutouts(views);
  return 0;
}
