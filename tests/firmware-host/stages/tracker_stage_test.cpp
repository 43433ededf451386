// Whatever rate the device measures and counts at: its poses are stamped when they were measured.
#include "firmware-host/stages/tracker_stage.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/stages/stage_lanes.hpp"
#include "tests/firmware-host/tracker/tracker_rig.hpp"

namespace orcart::testing {
namespace {

/// From a measurement to its reply being ready at the earliest: the device's latency and its processing time.
constexpr Nanos kLatency = 4300us;

struct StageRig {
  StageRig(double wished_hz, const NdiEmulatorSettings& device)
      : tracker(wishing(wished_hz), device),
        stage(tracker.driver, {.rate_hz = wished_hz, .device_latency = kLatency}, lanes) {}

  static NdiSettings wishing(double rate_hz) {
    NdiSettings settings = two_tools();
    settings.device_rate_hz = rate_hz;
    settings.poll_rate_hz = rate_hz * kPollsPerFrame;
    return settings;
  }
  /// The worst stamp of the samples in the next `time`, and whether the tracker was live all the while.
  Nanos worst_stamp(Nanos time) {
    Nanos worst{};
    const Instant end = tracker.clock.now() + time;
    while (tracker.clock.now() < end) {
      tracker.link.wait(std::min(end, tracker.driver.next_due()));
      (void)stage.step(tracker.clock.now());
      live = live && tracker.driver.health() == TrackerHealth::live;
      for (const PoseSample& sample : all_of(lanes.poses)) {
        const Instant truth = tracker.device.device_clock().measured_at(sample.device_frame);
        worst = std::max(worst, Nanos{std::abs((sample.measured_at - truth).count())});
        ++samples;
      }
    }
    return worst;
  }

  TrackerRig tracker;
  Lanes lanes{small_lanes()};
  TrackerStage stage;
  bool live = true;
  int samples = 0;
};

struct Case {
  std::string_view what;
  double wished_hz, measures_hz;
  NdiEmulatorSettings device;
};

TEST(TrackerStage, StampsWhatWasMeasuredWhateverTheCounterRunsAt) {
  const std::array<Case, 6> cases{{
      {"a Vega at 60 Hz", 60, 60, {}},
      {"a Vega at 20 Hz counts at 20 Hz", 20, 20, {}},
      {"a Polaris at 20 Hz counts at 60 Hz", 20, 20, {.model = NdiModel::polaris}},
      {"a Spectra at 30 Hz counts at 60 Hz", 30, 30, {.model = NdiModel::spectra}},
      {"a Vicra measures at 20 Hz whatever it is told",
       60,
       20,
       {.model = NdiModel::polaris, .measures_each = 3}},
      {"an older device that counts at 30 Hz",
       30,
       30,
       {.model = NdiModel::spectra, .frame_rate_hz = 30, .measures_each = 1}},
  }};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.what);
    NdiEmulatorSettings device = one.device;
    device.clock_drift_ppm = 40;
    StageRig rig(one.wished_hz, device);
    (void)rig.worst_stamp(8s);
    ASSERT_EQ(rig.tracker.driver.health(), TrackerHealth::live) << rig.tracker.driver.trouble_sentence();
    const std::uint32_t restarts = rig.stage.clock_fit().restarts();
    rig.samples = 0;
    rig.live = true;
    // At 20 polls a second the one that comes just after its frame is 6 s from the next: the fit knows less.
    EXPECT_LT(rig.worst_stamp(60s), one.wished_hz < 30 ? 1100us : 1000us);
    EXPECT_TRUE(rig.live);
    EXPECT_TRUE(rig.stage.clock_fit().settled());
    EXPECT_EQ(rig.stage.clock_fit().restarts(), restarts);
    EXPECT_GE(rig.samples, static_cast<int>(0.98 * 60 * one.measures_hz));
    EXPECT_EQ(rig.tracker.driver.counters().restarts, 0u);
  }
}

TEST(TrackerStage, TellsAnotherThreadWhatIsWrongAndWhatDoesNotPlease) {
  StageRig slow(60, {.model = NdiModel::polaris, .measures_each = 3});
  (void)slow.worst_stamp(8s);
  EXPECT_EQ(slow.tracker.driver.remark(slow.stage.state()),
            "the device measures at 20 Hz, not at the 60 Hz of rate_hz; write what it does");
  StageRig rig(60, {});
  (void)rig.worst_stamp(8s);
  EXPECT_EQ(rig.stage.state(), TrackerState{});
  const Instant now = rig.tracker.clock.now();
  rig.tracker.device.faults().add(
      {.fault = NdiFault::unplugged, .from = now, .until = now + 1s, .amount = 1});
  (void)rig.worst_stamp(500ms);
  EXPECT_EQ(
      rig.tracker.driver.remark(rig.stage.state()),
      "tool REFERENCE is not tracked: no tool in the port: unplugged, or its definition was not loaded");
  rig.tracker.device.faults().add({.fault = NdiFault::silence, .from = now + 500ms, .until = now + 2s});
  (void)rig.worst_stamp(1s);
  EXPECT_EQ(rig.tracker.driver.trouble_sentence(rig.stage.state()), "the tracker has fallen silent");
}

}  // namespace
}  // namespace orcart::testing
