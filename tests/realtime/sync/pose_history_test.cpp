// What the pose history says between, before and after its samples.
#include "realtime/sync/pose_history.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/sync/sync_samples.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using testing::at_ms;
using testing::sample_at;
using testing::unseen_at;
using testing::x_mm_at;

constexpr Nanos kPeriod = 16ms;

PoseHistory history_of(std::initializer_list<double> seen_ms, std::initializer_list<double> unseen_ms = {}) {
  std::vector<PoseSample> samples;
  for (double ms : seen_ms) samples.push_back(sample_at(at_ms(ms)));
  for (double ms : unseen_ms) samples.push_back(unseen_at(at_ms(ms)));
  std::ranges::sort(samples, {}, &PoseSample::measured_at);
  PoseHistory history({.period = kPeriod});
  for (const PoseSample& sample : samples) EXPECT_TRUE(history.push(sample));
  return history;
}

void expect_on_the_way(const PoseAnswer& answer, Instant t) {
  EXPECT_NEAR(answer.X_RS.translation_mm.x(), x_mm_at(t), 1e-9);
  EXPECT_NEAR(answer.X_RS.translation_mm.y(), 2, 1e-9);
  EXPECT_NEAR(answer.X_RS.translation_mm.z(), 3, 1e-9);
  EXPECT_TRUE(answer.X_RS.rotation.isIdentity(1e-9));
}

TEST(PoseHistory, GivesASampleAsItStandsWithinAFifthOfAMillisecond) {
  const PoseHistory history = history_of({0, 16});
  for (double ms : {-0.2, 0.0, 0.2}) {
    const PoseAnswer answer = history.at(at_ms(ms));
    EXPECT_EQ(answer.kind, PoseKind::exact) << ms;
    expect_on_the_way(answer, at_ms(0));
  }
  EXPECT_EQ(history.at(at_ms(0.201)).kind, PoseKind::interpolated);
}

TEST(PoseHistory, InterpolatesBetweenNeighboursAndSaysHowFarTheNearestIs) {
  const PoseHistory history = history_of({0, 16, 32});
  const PoseAnswer answer = history.at(at_ms(21));
  EXPECT_EQ(answer.kind, PoseKind::interpolated);
  EXPECT_EQ(answer.distance, 5ms);
  expect_on_the_way(answer, at_ms(21));
}

TEST(PoseHistory, InterpolatesInTheReferenceSoThatABumpedSensorDropsOut) {
  PoseHistory history({.period = kPeriod});
  PoseSample bumped = sample_at(at_ms(16));
  Pose<T, T> bump;
  bump.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  bump.translation_mm = {30, 0, 0};
  bumped.X_TR = bump * bumped.X_TR;
  bumped.X_TS = bump * bumped.X_TS;
  ASSERT_TRUE(history.push(sample_at(at_ms(0))));
  ASSERT_TRUE(history.push(bumped));
  expect_on_the_way(history.at(at_ms(9)), at_ms(9));
}

TEST(PoseHistory, BridgesOneMissingOrUnseenSampleButNotTwo) {
  EXPECT_EQ(history_of({0, 32}).at(at_ms(10)).kind, PoseKind::interpolated);
  EXPECT_EQ(history_of({0, 32}, {16}).at(at_ms(10)).kind, PoseKind::interpolated);
  EXPECT_EQ(history_of({0, 48}).at(at_ms(10)).kind, PoseKind::none);
  EXPECT_EQ(history_of({0, 48}, {16, 32}).at(at_ms(10)).kind, PoseKind::none);
}

TEST(PoseHistory, NeedsScopeAndReferenceInTheSameSample) {
  PoseHistory history({.period = kPeriod});
  PoseSample no_reference = sample_at(at_ms(0));
  no_reference.reference = ToolState::doubtful;
  ASSERT_TRUE(history.push(no_reference));
  ASSERT_TRUE(history.push(unseen_at(at_ms(16))));
  EXPECT_EQ(history.at(at_ms(0)).kind, PoseKind::none);
  EXPECT_EQ(history.at(at_ms(8)).kind, PoseKind::none);
}

TEST(PoseHistory, PredictsWithTheLastVelocityForAtMostFiftyMilliseconds) {
  const PoseHistory history = history_of({0, 16});
  const PoseAnswer answer = history.at(at_ms(40));
  EXPECT_EQ(answer.kind, PoseKind::predicted);
  EXPECT_EQ(answer.distance, 24ms);
  expect_on_the_way(answer, at_ms(40));
  EXPECT_FALSE(answer.may_paint());
  EXPECT_EQ(history.at(at_ms(66)).kind, PoseKind::predicted);
  EXPECT_EQ(history.at(at_ms(66.001)).kind, PoseKind::none);
}

TEST(PoseHistory, DoesNotPredictFromATimeWhenTheToolIsUnseenAlready) {
  EXPECT_EQ(history_of({0, 16}, {32}).at(at_ms(40)).kind, PoseKind::none);
}

TEST(PoseHistory, SaysNothingBeforeItsFirstSampleOrWithoutAny) {
  EXPECT_EQ(history_of({10, 26}).at(at_ms(5)).kind, PoseKind::none);
  EXPECT_EQ(history_of({}).at(at_ms(5)).kind, PoseKind::none);
}

TEST(PoseHistory, RefusesSamplesThatFallBackOrComeFromAfterTheirArrival) {
  PoseHistory history = history_of({0, 16});
  EXPECT_FALSE(history.push(sample_at(at_ms(16))));
  EXPECT_FALSE(history.push(sample_at(at_ms(3))));
  PoseSample future = sample_at(at_ms(40));
  future.arrived_at = at_ms(39);
  EXPECT_FALSE(history.push(future));
  EXPECT_EQ(history.refused(), 3U);
  EXPECT_TRUE(history.push(sample_at(at_ms(32))));
}

TEST(PoseHistory, ForgetsTheOldestSample) {
  PoseHistory history({.period = kPeriod, .capacity = 4});
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(history.push(sample_at(at_ms(16 * i))));
  EXPECT_EQ(history.at(at_ms(20)).kind, PoseKind::none);
  EXPECT_EQ(history.at(at_ms(40)).kind, PoseKind::interpolated);
}

TEST(PoseHistory, IsDecidedOnceNoSampleToComeCanChangeTheAnswer) {
  EXPECT_FALSE(history_of({0}).decided(at_ms(8)));
  EXPECT_TRUE(history_of({0}).decided(at_ms(0.1)));
  EXPECT_TRUE(history_of({0, 16}).decided(at_ms(8)));
  EXPECT_FALSE(history_of({0}, {16}).decided(at_ms(8)));  // a sample at 32 ms would still bridge
  EXPECT_TRUE(history_of({0}, {16, 32, 48}).decided(at_ms(8)));
  EXPECT_TRUE(history_of({}, {0, 16}).decided(at_ms(8)));
  EXPECT_FALSE(history_of({}).decided(at_ms(8)));
}

TEST(PoseHistory, KnowsWhetherTheDeviceLookedAtAll) {
  EXPECT_TRUE(history_of({}, {0, 16}).sampled_around(at_ms(8)));
  EXPECT_FALSE(history_of({0, 80}).sampled_around(at_ms(8)));
  EXPECT_FALSE(history_of({0}).sampled_around(at_ms(8)));
}

TEST(PoseHistory, TellsTheVelocityOverATenthOfASecond) {
  const PoseHistory history = history_of({0, 16, 32, 48, 64, 80, 96, 112, 128});
  const auto velocity = history.velocity(at_ms(100));
  ASSERT_TRUE(velocity);
  EXPECT_NEAR((*velocity)[0], testing::kSpeed_mm_per_s, 1e-6);
  EXPECT_LT(velocity->tail<5>().norm(), 1e-6);
}

TEST(PoseHistory, TellsATurnsVelocityInTheMarkersAxes) {
  PoseHistory history({.period = kPeriod});
  const double rad_s = 0.5;
  for (int ms = 0; ms <= 96; ms += 16) {
    PoseSample sample = sample_at(at_ms(ms));
    Pose<R, S> X_RS;
    X_RS.rotation = Eigen::AngleAxisd(1e-3 * ms * rad_s, Eigen::Vector3d::UnitY()).toRotationMatrix();
    sample.X_TS = sample.X_TR * X_RS;
    ASSERT_TRUE(history.push(sample));
  }
  const auto velocity = history.velocity(at_ms(90));
  ASSERT_TRUE(velocity);
  EXPECT_NEAR((*velocity)[4], rad_s, 1e-9);
}

TEST(PoseHistory, TellsNoVelocityFromTooShortABase) {
  EXPECT_FALSE(history_of({}).velocity(at_ms(0)));
  EXPECT_FALSE(history_of({96}).velocity(at_ms(96)));
  EXPECT_FALSE(history_of({64, 80, 96}).velocity(at_ms(96)));
  EXPECT_FALSE(history_of({0, 64, 80, 112}, {16, 32, 48}).velocity(at_ms(100)));  // 64 to 112 is 48 ms
  EXPECT_TRUE(history_of({0, 48, 64, 80, 112}, {16, 32}).velocity(at_ms(100)));
}

TEST(PoseHistory, AllocatesNothing) {
  PoseHistory history({.period = kPeriod});
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (int i = 0; i < 200; ++i) (void)history.push(sample_at(at_ms(16 * i)));
    (void)history.at(at_ms(16 * 190 + 4));
    (void)history.at(at_ms(16 * 199 + 4));
    (void)history.decided(at_ms(16 * 190 + 4));
    (void)history.velocity(at_ms(16 * 190 + 4));
  }));
}

}  // namespace
}  // namespace orcart
