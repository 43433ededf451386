// The covariance of a fitted body against the textbook and against fits to noisy points.
#include "realtime/registration/body_covariance.hpp"

#include <gtest/gtest.h>

#include <random>

#include "realtime/registration/rigid_fit.hpp"

namespace orcart {
namespace {

using Points = std::vector<Eigen::Vector3d>;

TEST(BodyCovariance, OfFourPointsOnAxesIsTheTextbooks) {
  const Points points{{10, 0, 0}, {-10, 0, 0}, {0, 10, 0}, {0, -10, 0}};
  const TwistCovariance covariance = body_covariance(points, 0.2);
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.2 / 2, 1e-12);
  EXPECT_NEAR(std::sqrt(covariance(5, 5)), 0.2 / std::sqrt(400.0), 1e-12);  // about z: sum of r^2
  EXPECT_NEAR(std::sqrt(covariance(3, 3)), 0.2 / std::sqrt(200.0), 1e-12);
}

TEST(BodyCovariance, ATargetsErrorIsThatOfFitsToNoisyPoints) {
  const Points points{{0, 0, 0}, {0, 52, 18}, {46, -31, 9}, {-38, -44, 0}};
  const Eigen::Vector3d target(6, -48, 262);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.1);
  constexpr int kDraws = 4000;
  double drawn2 = 0;
  for (int i = 0; i < kDraws; ++i) {
    Points seen = points;
    for (Eigen::Vector3d& p : seen) p += Eigen::Vector3d(noise(random), noise(random), noise(random));
    const auto fit = rigid_fit({.from_mm = points, .to_mm = seen});
    drawn2 += (fit->rotation * target + fit->translation_mm - target).squaredNorm() / kDraws;
  }
  Pose<S, C> there;
  there.translation_mm = target;
  const TwistCovariance at_target = covariance_seen_from(there, body_covariance(points, 0.1));
  EXPECT_NEAR(std::sqrt(drawn2 / at_target.topLeftCorner<3, 3>().trace()), 1, 0.03);
}

}  // namespace
}  // namespace orcart
