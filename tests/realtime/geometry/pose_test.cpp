// Poses: chains, inverses, interpolation, and the nearest rotation to a matrix from a file.
#include "realtime/geometry/pose.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace orcart {
namespace {

Eigen::Matrix3d turn(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
}

TEST(Pose, TakesAPointOfBToA) {
  const Pose<M, C> X_MC{.rotation = turn(std::numbers::pi / 2, {0, 0, 1}), .translation_mm = {10, 0, 0}};
  EXPECT_TRUE((X_MC * Point<C>{{1, 2, 3}}).mm.isApprox(Eigen::Vector3d(8, 1, 3)));
  EXPECT_TRUE((X_MC * Direction<C>{{1, 0, 0}}).xyz.isApprox(Eigen::Vector3d(0, 1, 0)));
}

TEST(Pose, InverseTakesBack) {
  const Pose<M, C> X_MC{.rotation = turn(0.7, {1, 2, 3}), .translation_mm = {4, 5, 6}};
  const Eigen::Vector3d p(7, -8, 9);
  EXPECT_TRUE((X_MC.inverse() * (X_MC * Point<C>{p})).mm.isApprox(p, 1e-14));
}

TEST(Pose, ChainsWhereFramesMeet) {
  const Pose<M, R> X_MR{.rotation = turn(0.3, {0, 1, 0}), .translation_mm = {1, 2, 3}};
  const Pose<R, S> X_RS{.rotation = turn(0.5, {1, 0, 0}), .translation_mm = {-4, 0, 9}};
  const Point<S> p{{1, 1, 1}};
  EXPECT_TRUE(((X_MR * X_RS) * p).mm.isApprox((X_MR * (X_RS * p)).mm, 1e-14));
}

TEST(Pose, HalfWayHalvesAngleAndDistance) {
  const Pose<R, S> from{}, to{.rotation = turn(0.8, {1, 1, 0}), .translation_mm = {2, 4, 6}};
  const Pose<R, S> middle = interpolate(from, to, 0.5);
  EXPECT_NEAR(angle_between_rad(from, middle), 0.4, 1e-12);
  EXPECT_TRUE(middle.translation_mm.isApprox(Eigen::Vector3d(1, 2, 3)));
}

TEST(NearestRotation, LeavesARotationAsItIs) {
  const Eigen::Matrix3d r = turn(1.2, {3, -1, 2});
  const NearestRotation nearest = nearest_rotation(r);
  EXPECT_TRUE(nearest.rotation.isApprox(r, 1e-14));
  EXPECT_LT(nearest.deviation, 1e-14);
  EXPECT_FALSE(nearest.reflected);
}

TEST(NearestRotation, MeasuresAScaleAndTakesItOut) {
  const Eigen::Matrix3d r = turn(0.4, {0, 1, 1});
  const NearestRotation nearest = nearest_rotation(1.004 * r);
  EXPECT_TRUE(nearest.rotation.isApprox(r, 1e-13));
  EXPECT_NEAR(nearest.deviation, 1.004 * 1.004 - 1, 1e-12);
}

TEST(NearestRotation, TellsAReflectionAndStillAnswersARotation) {
  Eigen::Matrix3d mirror = turn(0.9, {1, 0, 2});
  mirror.col(2) *= -1;
  const NearestRotation nearest = nearest_rotation(mirror);
  EXPECT_TRUE(nearest.reflected);
  EXPECT_NEAR(nearest.rotation.determinant(), 1, 1e-12);
}

TEST(NearestRotation, DeviatesInfinitelyWhereAnEntryIsNotANumber) {
  Eigen::Matrix3d bad = Eigen::Matrix3d::Identity();
  bad(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GT(nearest_rotation(bad).deviation, 1e9);
}

}  // namespace
}  // namespace orcart
