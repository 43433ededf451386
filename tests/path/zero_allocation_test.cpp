// No step before the GL driver asks the heap or takes a lock: pedal, tracker, camera, match and mapper,
// driven by the simulated devices through a procedure. The painter's and panel's steps end in the GL driver,
// which allocates as it likes, and the guard cannot tell its calls from ours; those two are left to the
// atlas's and views' own tests.
#include <gtest/gtest.h>

#include "firmware-host/stages/camera_stage.hpp"
#include "firmware-host/stages/mapper_stage.hpp"
#include "firmware-host/stages/pedal_stage.hpp"
#include "firmware-host/stages/sync_stage.hpp"
#include "firmware-host/stages/tracker_stage.hpp"
#include "realtime/kernel/simulated_runner.hpp"
#include "tests/path/cart_rig.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

/// Runs a stage under the guard and remembers the first step that asked for anything.
class GuardedStage final : public Stage {
 public:
  explicit GuardedStage(Stage& stage) : stage_(stage) {}
  std::string_view name() const noexcept override { return stage_.name(); }
  StepReport step(Instant now) noexcept override {
    NoAllocationScope scope;
    const StepReport report = stage_.step(now);
    scope.disarm();
    worked_ += report.worked;
    const HeapAndLockCounts counts = scope.counts();
    if (counts.allocations + counts.frees + counts.locks > 0) {
      ++guilty_;
      if (first_.empty()) first_ = asked_nothing(scope).message();
    }
    return report;
  }

  int guilty() const { return guilty_; }
  int worked() const { return worked_; }
  const std::string& first() const { return first_; }

 private:
  Stage& stage_;
  int guilty_ = 0, worked_ = 0;
  std::string first_;
};

/// The painter's part without a picture: everything lent goes home.
class LettingGo final : public Stage {
 public:
  LettingGo(Lanes& lanes, const std::vector<CutoutPatch>& patches)
      : lanes_(lanes), patches_(patches), holds_(kFrameBuffers, 0) {}
  std::string_view name() const noexcept override { return "letting go"; }
  StepReport step(Instant) noexcept override {
    PaintOrder order;
    while (lanes_.orders.try_pop(order)) {
      if (order.kind == PaintOrderKind::show) {
        if (newest_) let_go(*newest_);
        newest_ = order.frame.buffer;
        holds_[*newest_] = 2;
      } else if (order.kind == PaintOrderKind::release) {
        let_go(order.frame.buffer);
      } else if (order.kind == PaintOrderKind::paint) {
        const bool last = patches_[order.patch].last_part;
        triangles_ += patches_[order.patch].triangles.size();
        (void)lanes_.patches_home.try_push(order.patch);
        if (last) let_go(order.frame.buffer);
      }
    }
    return {};
  }
  std::size_t triangles() const { return triangles_; }

 private:
  void let_go(std::uint32_t buffer) {
    if (--holds_[buffer] == 0) (void)lanes_.frames_home.try_push(buffer);
  }
  Lanes& lanes_;
  const std::vector<CutoutPatch>& patches_;
  std::vector<int> holds_;
  std::optional<std::uint32_t> newest_;
  std::size_t triangles_ = 0;
};

NdiSettings tracker_of(const CartConfig& config) {
  NdiSettings settings{.poll_rate_hz = config.tracker.rate_hz,
                       .device_rate_hz = config.tracker.rate_hz,
                       .baud = config.tracker.baud};
  for (const auto& file : {config.tracker.scope_rom, config.tracker.reference_rom})
    settings.tools.push_back(ndi::read_tool_definition(file).value());
  return settings;
}

/// A copy would lose the room that a patch was given.
std::vector<CutoutPatch> empty_patches() {
  std::vector<CutoutPatch> patches;
  for (std::size_t i = 0; i < kPatchSlots; ++i) patches.emplace_back(patch_capacity({}));
  return patches;
}

/// The stages before the GPU, each guarded, on the rig's devices.
struct GuardedStages {
  explicit GuardedStages(CartRig& rig)
      : ports(rig.devices->ports()),
        mapper(Mapper::create(rig.patient.surface, rig.config.seen_from, rig.patient.scope).value()),
        driver(tracker_of(rig.config), ports.tracker),
        pedal(ports.pedal, PedalSettings{}, lanes),
        tracker(driver, {.rate_hz = rig.config.tracker.rate_hz, .device_latency = 8ms}, lanes),
        wake(ports.tracker, driver),
        camera(ports.camera, rig.clock, {.meaning = rig.config.camera.stamp, .exposure = 8ms}, lanes),
        sync({.history = {.period = period_of(rig.config.tracker.rate_hz)},
              .matcher = {},
              .selector = {},
              .X_MR = rig.patient.registration.X_MR,
              .scope = rig.patient.scope},
             lanes),
        mapping(mapper, patches, rig.clock,
                {.X_MR = rig.patient.registration.X_MR, .scope = rig.patient.scope}, lanes),
        letting_go(lanes, patches) {}

  std::vector<ThreadPlan> plans() {
    std::vector<ThreadPlan> plans(5);
    plans[0] = {.spec = spec_of(ThreadId::pedal), .stages = {&guards[0]}, .wake = &ports.pedal};
    plans[1] = {.spec = spec_of(ThreadId::tracker), .stages = {&guards[1]}, .wake = &wake};
    plans[2] = {.spec = spec_of(ThreadId::camera), .stages = {&guards[2]}, .wake = &ports.camera};
    plans[3] = {.spec = spec_of(ThreadId::mapping), .stages = {&guards[3], &guards[4]}};
    plans[4] = {.spec = spec_of(ThreadId::render), .stages = {&letting_go}};
    return plans;
  }

  Ports ports;
  Lanes lanes{{.poses = kPoseQueueDepth,
               .pedal = kPedalQueueDepth,
               .frames = kFrameQueueDepth,
               .orders = kPaintQueueDepth,
               .patches = kPatchSlots}};
  std::vector<CutoutPatch> patches = empty_patches();
  Mapper mapper;
  NdiDriver driver;
  PedalStage pedal;
  TrackerStage tracker;
  TrackerWake wake;
  CameraStage camera;
  SyncStage sync;
  MapperStage mapping;
  LettingGo letting_go;
  std::array<GuardedStage, 5> guards{GuardedStage(pedal), GuardedStage(tracker), GuardedStage(camera),
                                     GuardedStage(sync), GuardedStage(mapping)};
};

TEST(ZeroAllocation, NoStepBeforeTheGpuAsksTheHeapFromTheFirstOn) {
  auto rig = CartRig::create(stream());
  ASSERT_TRUE(rig);
  GuardedStages stages(*rig);
  ASSERT_TRUE(stages.ports.camera.start());
  SimulatedRunner runner(stages.plans(), rig->clock);
  runner.run_until(rig->devices->end());
  for (const GuardedStage& guard : stages.guards) {
    EXPECT_GT(guard.worked(), 0) << guard.name();
    EXPECT_EQ(guard.guilty(), 0) << guard.name() << ": " << guard.first();
  }
  EXPECT_GT(stages.letting_go.triangles(), 1000u);
}

/// A stage with the bug that the guard is there for.
class Leaky final : public Stage {
 public:
  std::string_view name() const noexcept override { return "leaky"; }
  StepReport step(Instant now) noexcept override {
    seen_.push_back(now);
    return {.worked = true};
  }

 private:
  std::vector<Instant> seen_;
};

TEST(ZeroAllocation, AStageThatKeepsAGrowingListIsCaught) {
  if (!kAllocationGuardWorks) GTEST_SKIP() << "sanitizers bring a malloc of their own";
  Leaky leaky;
  GuardedStage guard(leaky);
  SimulatedClock clock;
  ThreadPlan plan{.spec = {.name = "leaky", .rate_hz = 100}, .stages = {&guard}};
  SimulatedRunner runner({plan}, clock);
  runner.run_until(clock.now() + 100ms);
  EXPECT_GT(guard.guilty(), 0);
  EXPECT_NE(guard.first().find("allocations"), std::string::npos) << guard.first();
}

}  // namespace
}  // namespace orcart::testing
