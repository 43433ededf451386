// LIVE, STALE and LOST at their limits, and a picture that stands still.
#include "realtime/sync/freshness.hpp"

#include <gtest/gtest.h>

#include "realtime/sync/freeze_detector.hpp"
#include "tests/realtime/sync/sync_samples.hpp"

namespace orcart {
namespace {

using testing::at_ms;

TEST(Freshness, InhibitsPaintAfterFiftyMillisecondsOfSilenceAndLosesTheTrackerAfterAHundred) {
  const FreshnessRules rules{.tracker_period = 16ms};
  EXPECT_EQ(rules.tracker(at_ms(49.999), at_ms(0)), Liveness::live);
  EXPECT_EQ(rules.tracker(at_ms(50), at_ms(0)), Liveness::stale);
  EXPECT_EQ(rules.tracker(at_ms(99.999), at_ms(0)), Liveness::stale);
  EXPECT_EQ(rules.tracker(at_ms(100), at_ms(0)), Liveness::lost);
}

TEST(Freshness, WaitsThreeAndFourPeriodsOfASlowTracker) {
  const FreshnessRules rules{.tracker_period = 50ms};
  EXPECT_EQ(rules.tracker(at_ms(149.999), at_ms(0)), Liveness::live);
  EXPECT_EQ(rules.tracker(at_ms(150), at_ms(0)), Liveness::stale);
  EXPECT_EQ(rules.tracker(at_ms(199.999), at_ms(0)), Liveness::stale);
  EXPECT_EQ(rules.tracker(at_ms(200), at_ms(0)), Liveness::lost);
}

TEST(Freshness, MissesTheToolAfterAPeriodAndFiveMilliseconds) {
  const FreshnessRules rules{.tracker_period = 16ms};
  EXPECT_TRUE(rules.tool_seen(at_ms(21), at_ms(0)));
  EXPECT_FALSE(rules.tool_seen(at_ms(21.001), at_ms(0)));
}

TEST(Freshness, CountsAFrameAtOneAndAHalfPeriodsAndLosesTheVideoAfterAQuarterOfASecond) {
  const FreshnessRules rules{.video_period = 33ms};
  EXPECT_FALSE(rules.video_overdue(at_ms(49.499), at_ms(0)));
  EXPECT_TRUE(rules.video_overdue(at_ms(49.5), at_ms(0)));
  EXPECT_EQ(rules.video(at_ms(99.999), at_ms(0)), Liveness::live);
  EXPECT_EQ(rules.video(at_ms(100), at_ms(0)), Liveness::stale);
  EXPECT_EQ(rules.video(at_ms(249.999), at_ms(0)), Liveness::stale);
  EXPECT_EQ(rules.video(at_ms(250), at_ms(0)), Liveness::lost);
}

TEST(Freshness, WaitsThreeAndSixPeriodsOfASlowCamera) {
  const FreshnessRules rules{.video_period = 100ms};
  EXPECT_EQ(rules.video(at_ms(299.999), at_ms(0)), Liveness::live);
  EXPECT_EQ(rules.video(at_ms(300), at_ms(0)), Liveness::stale);
  EXPECT_EQ(rules.video(at_ms(600), at_ms(0)), Liveness::lost);
}

TEST(Freshness, TakesNoStampFromTheFutureForLive) {
  const FreshnessRules rules{.tracker_period = 16ms, .video_period = 33ms};
  EXPECT_EQ(rules.video(at_ms(0), at_ms(1)), Liveness::live);
  EXPECT_EQ(rules.video(at_ms(0), at_ms(1.001)), Liveness::lost);
  EXPECT_EQ(rules.tracker(at_ms(0), at_ms(1.001)), Liveness::lost);
  EXPECT_FALSE(rules.tool_seen(at_ms(0), at_ms(1.001)));
}

TEST(Freshness, IsLostBeforeAnythingCame) {
  const FreshnessRules rules{.tracker_period = 16ms, .video_period = 33ms};
  EXPECT_EQ(rules.video(at_ms(0), Instant{}), Liveness::lost);
  EXPECT_EQ(rules.tracker(at_ms(0), Instant{}), Liveness::lost);
  EXPECT_FALSE(rules.tool_seen(at_ms(0), Instant{}));
}

TEST(FreezeDetector, SaysFrozenWhenTheSamePictureHasComeForASecond) {
  FreezeDetector detector;
  EXPECT_FALSE(detector.see(0, at_ms(0), 77));
  EXPECT_FALSE(detector.see(1, at_ms(999.999), 77));
  EXPECT_TRUE(detector.see(2, at_ms(1000), 77));
  EXPECT_EQ(detector.repeats(), 2U);
  EXPECT_FALSE(detector.see(3, at_ms(1033), 78));
}

TEST(FreezeDetector, LeavesMovingPicturesAlone) {
  FreezeDetector detector;
  for (std::uint32_t i = 0; i < 300; ++i) EXPECT_FALSE(detector.see(i, at_ms(33 * i), i % 2));
  EXPECT_EQ(detector.repeats(), 0U);
}

TEST(FreezeDetector, NeedsTheSequenceToAdvance) {
  FreezeDetector detector;
  EXPECT_FALSE(detector.see(5, at_ms(0), 77));
  EXPECT_FALSE(detector.see(5, at_ms(2000), 77));  // the same frame once more: no news, that is for staleness
}

}  // namespace
}  // namespace orcart
