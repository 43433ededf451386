// Frames that wait for their pose: how long, how many, and with which answer they leave.
#include "realtime/sync/frame_matcher.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/sync/sync_samples.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using testing::at_ms;
using testing::frame_at;
using testing::sample_at;
using testing::unseen_at;
using testing::x_mm_at;

struct Bench {
  FrameMatcher matcher;
  PoseHistory poses{{.period = 16ms}};

  explicit Bench(const FrameMatcherSettings& settings = {}) : matcher(settings) {}
  void hold(double mid_ms, std::uint32_t sequence = 0) {
    EXPECT_FALSE(matcher.add(frame_at(at_ms(mid_ms), sequence)));
  }
  void see(double ms) { EXPECT_TRUE(poses.push(sample_at(at_ms(ms)))); }
  void miss(double ms) { EXPECT_TRUE(poses.push(unseen_at(at_ms(ms)))); }
  auto next(double now_ms) { return matcher.next(at_ms(now_ms), poses); }
};

TEST(FrameMatcher, AnswersAsSoonAsTheBracketIsInHand) {
  Bench bench;
  bench.see(0);
  bench.hold(8);
  EXPECT_FALSE(bench.next(20));
  bench.see(16);
  const auto answer = bench.next(20);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->refusal, Refusal::none);
  EXPECT_EQ(answer->pose.kind, PoseKind::interpolated);
  EXPECT_NEAR(answer->pose.X_RS.translation_mm.x(), x_mm_at(at_ms(8)), 1e-9);
  EXPECT_EQ(bench.matcher.held(), 0U);
}

TEST(FrameMatcher, LooksThePoseUpAtMidExposurePlusTheCalibratedOffset) {
  Bench bench({.tracker_against_video = 5ms});
  bench.see(0);
  bench.see(16);
  bench.hold(8);
  const auto answer = bench.next(20);
  ASSERT_TRUE(answer);
  EXPECT_NEAR(answer->pose.X_RS.translation_mm.x(), x_mm_at(at_ms(13)), 1e-9);
}

TEST(FrameMatcher, HoldsAFrameUntilNoPedalEdgeThatMeansItCanBeOnItsWay) {
  Bench bench;
  bench.see(0);
  bench.see(16);
  bench.hold(8);
  EXPECT_FALSE(bench.matcher.next(at_ms(32.999), bench.poses, 25ms));
  EXPECT_TRUE(bench.matcher.next(at_ms(33), bench.poses, 25ms));
}

TEST(FrameMatcher, GivesUpSixtyMillisecondsAfterMidExposure) {
  Bench bench;
  bench.see(0);
  bench.hold(8);
  EXPECT_FALSE(bench.next(67.999));
  const auto answer = bench.next(68);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->refusal, Refusal::too_late);
}

TEST(FrameMatcher, SaysThatTheToolWasUnseenWhereTheDeviceLookedAndDidNotSeeIt) {
  Bench bench;
  bench.miss(0);
  bench.hold(8);
  bench.miss(16);
  const auto answer = bench.next(20);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->refusal, Refusal::tool_unseen);
  EXPECT_FALSE(answer->pose.may_paint());
}

TEST(FrameMatcher, SaysThatThereIsNoPoseWhereTheDeviceWasSilent) {
  Bench bench;
  bench.see(0);
  bench.hold(20);
  bench.see(64);
  const auto answer = bench.next(66);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->refusal, Refusal::no_pose);
}

TEST(FrameMatcher, RefusesTheOldestWhereAFifthComes) {
  Bench bench;
  for (std::uint32_t i = 0; i < 4; ++i) bench.hold(8 * i, i);
  const auto evicted = bench.matcher.add(frame_at(at_ms(32), 4));
  ASSERT_TRUE(evicted);
  EXPECT_EQ(evicted->frame.sequence, 0U);
  EXPECT_EQ(evicted->refusal, Refusal::queue_full);
  EXPECT_EQ(bench.matcher.held(), 4U);
}

TEST(FrameMatcher, AnswersInOrder) {
  Bench bench;
  bench.see(0);
  for (std::uint32_t i = 0; i < 3; ++i) bench.hold(4 + 4 * i, i);
  bench.see(16);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(bench.next(20)->frame.sequence, i);
  EXPECT_FALSE(bench.next(20));
}

TEST(FrameMatcher, RefusesAFrameFromTheFutureAtOnce) {
  Bench bench;
  CapturedFrame frame = frame_at(at_ms(10));
  frame.dequeued_at = frame.exposure_end - 1ms;
  EXPECT_FALSE(bench.matcher.add(frame));
  frame.dequeued_at -= 1ns;
  const auto refused = bench.matcher.add(frame);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->refusal, Refusal::stamp_in_future);
}

TEST(FrameMatcher, RefusesAFrameThatGoesBackAndCallsTheThirdAFault) {
  Bench bench;
  bench.hold(50);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(bench.matcher.stamps_faulty());
    EXPECT_EQ(bench.matcher.add(frame_at(at_ms(40 + i)))->refusal, Refusal::stamp_backwards);
  }
  EXPECT_TRUE(bench.matcher.stamps_faulty());
  EXPECT_FALSE(bench.matcher.add(frame_at(at_ms(43))));  // the driver's clock was set: count anew from there
  EXPECT_FALSE(bench.matcher.stamps_faulty());
}

TEST(FrameMatcher, AllocatesNothing) {
  Bench bench;
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (int i = 0; i < 100; ++i) {
      (void)bench.poses.push(sample_at(at_ms(16 * i)));
      (void)bench.matcher.add(frame_at(at_ms(16 * i + 8)));
      while (bench.matcher.next(at_ms(16 * i + 14), bench.poses)) {
      }
    }
  }));
}

PoseSample turned_at(Instant t, double turn_rad) {
  PoseSample sample = sample_at(t);
  sample.turn_rad = turn_rad;
  return sample;
}

TEST(FrameMatcherTurn, IsInterpolatedTheShorterWayRoundFromSamplesOfTheSameInstantsAsThePose) {
  PoseHistory poses({.period = 16ms, .needs_turn = true});
  FrameMatcher matcher({.turn = TurnSource::marker});
  (void)matcher.add(frame_at(at_ms(20)));
  ASSERT_TRUE(poses.push(turned_at(at_ms(16), 3.0)));
  ASSERT_TRUE(poses.push(turned_at(at_ms(32), -3.0)));
  const auto matched = matcher.next(at_ms(45), poses);
  ASSERT_TRUE(matched);
  EXPECT_EQ(matched->refusal, Refusal::none);
  EXPECT_NEAR(matched->turn_rad, 3.0 + 0.25 * (2 * 3.14159265358979 - 6.0), 1e-9);
}

TEST(FrameMatcherTurn, ThatTheMarkersDoNotTellRefusesTheFrameAndSaysSo) {
  PoseHistory poses({.period = 16ms, .needs_turn = true});
  FrameMatcher matcher({.turn = TurnSource::marker});
  (void)matcher.add(frame_at(at_ms(20)));
  for (const double ms : {0.0, 16.0, 32.0, 48.0})
    ASSERT_TRUE(poses.push(ms == 0 ? turned_at(at_ms(ms), 1) : sample_at(at_ms(ms))));
  const auto matched = matcher.next(at_ms(60), poses);
  ASSERT_TRUE(matched);
  EXPECT_EQ(matched->refusal, Refusal::turn_unknown);
}

TEST(FrameMatcherTurn, ThatIsMissingInOneSampleIsBridgedAsAPoseIs) {
  PoseHistory poses({.period = 16ms, .needs_turn = true});
  FrameMatcher matcher({.turn = TurnSource::marker});
  (void)matcher.add(frame_at(at_ms(20)));
  ASSERT_TRUE(poses.push(turned_at(at_ms(0), 1)));
  ASSERT_TRUE(poses.push(sample_at(at_ms(16))));
  ASSERT_TRUE(poses.push(turned_at(at_ms(32), 1.32)));
  const auto matched = matcher.next(at_ms(60), poses);
  ASSERT_TRUE(matched);
  EXPECT_EQ(matched->refusal, Refusal::none);
  EXPECT_NEAR(matched->turn_rad, 1.2, 1e-9);
}

TEST(FrameMatcherTurn, ByTheNotchIsTheFramesOwnOrTheFrameIsRefused) {
  PoseHistory poses({.period = 16ms});
  FrameMatcher matcher({.turn = TurnSource::notch});
  CapturedFrame seen = frame_at(at_ms(20)), unseen = frame_at(at_ms(24));
  seen.notch_turn_rad = 0.7;
  (void)matcher.add(seen);
  (void)matcher.add(unseen);
  for (const double ms : {16.0, 32.0}) ASSERT_TRUE(poses.push(sample_at(at_ms(ms))));
  const auto first = matcher.next(at_ms(60), poses), second = matcher.next(at_ms(60), poses);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->refusal, Refusal::none);
  EXPECT_EQ(first->turn_rad, 0.7);
  EXPECT_EQ(second->refusal, Refusal::turn_unknown);
}

}  // namespace
}  // namespace orcart
