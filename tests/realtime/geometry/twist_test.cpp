// A twist seen from another frame does there what it did here.
#include "realtime/geometry/twist.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

Pose<R, C> far_and_turned() {
  return {.rotation = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
          .translation_mm = {40, -120, 262}};
}

TEST(Twist, SeenFromAnotherFrameMovesAPointAlike) {
  const Pose<R, C> X_RC = far_and_turned();
  Twist in_R;
  in_R << 0.02, -0.01, 0.03, 1e-4, 2e-4, -3e-4;
  const Twist in_C = twist_seen_from(X_RC) * in_R;
  const Point<C> p{{3, -4, 15}};
  const Eigen::Vector3d there = (moved(Pose<R, R>{}, in_R) * X_RC * p).mm, here = (moved(X_RC, in_C) * p).mm;
  EXPECT_LT((there - here).norm(), 2e-5);  // second order: the turn's square over 300 mm
  EXPECT_GT((there - (X_RC * p).mm).norm(), 0.05);
}

TEST(Twist, BetweenTwoPosesTakesTheFirstToTheSecond) {
  Twist twist;
  twist << 2, -1, 3, 0.1, 0.2, -0.3;
  const Pose<R, C> X_RC = far_and_turned();
  EXPECT_LT((twist_between(X_RC, moved(X_RC, twist)) - twist).norm(), 1e-12);
  EXPECT_LT(twist_between(X_RC, X_RC).norm(), 1e-12);
}

TEST(TwistCovariance, OfATurnActsOverTheLever) {
  TwistCovariance in_R = TwistCovariance::Zero();
  in_R(3, 3) = 1e-6;  // about x
  Pose<R, C> X_RC;
  X_RC.translation_mm = {0, 0, 250};
  const TwistCovariance in_C = covariance_seen_from(X_RC, in_R);
  EXPECT_NEAR(std::sqrt(in_C(1, 1)), 0.25, 1e-12);
  EXPECT_NEAR(in_C(1, 3), -250e-6, 1e-15);
  EXPECT_NEAR(in_C(3, 3), 1e-6, 1e-18);
}

}  // namespace
}  // namespace orcart
