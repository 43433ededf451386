// Rests are found between movements, and noise is told from drift.
#include "tools/registration/rests.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

std::vector<Eigen::Vector3d> along_x(const std::vector<double>& x_mm) {
  std::vector<Eigen::Vector3d> places;
  for (const double x : x_mm) places.emplace_back(x, 0, 0);
  return places;
}

TEST(Rests, LieBetweenMovements) {
  const auto rests = rests_of(along_x({0, 0.2, 0, 5, 9, 9.2, 9.4, 9.2, 20}), {.frames = 3, .within_mm = 1});
  ASSERT_EQ(rests.size(), 2U);
  EXPECT_EQ(rests[0].first, 0U);
  EXPECT_EQ(rests[0].count, 3U);
  EXPECT_NEAR(rests[0].mean_mm.x(), 0.2 / 3, 1e-12);
  EXPECT_EQ(rests[1].first, 4U);
  EXPECT_EQ(rests[1].count, 4U);
  EXPECT_NEAR(rests[1].mean_mm.x(), 9.2, 1e-12);
}

TEST(Rests, AreNoneInFewerPlacesThanARestLasts) {
  EXPECT_TRUE(rests_of({}, {.frames = 3, .within_mm = 1}).empty());
  EXPECT_TRUE(rests_of(along_x({0, 0}), {.frames = 3, .within_mm = 1}).empty());
}

TEST(SuccessiveRatio, IsLargeForJumpsAndSmallForADrift) {
  const auto jumps = along_x({1, -1, 1, -1}), drift = along_x({0, 1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(successive_ratio(jumps, {.first = 0, .count = 4}), 3 * 4 / 4.0);
  EXPECT_DOUBLE_EQ(successive_ratio(drift, {.first = 0, .count = 5, .mean_mm = {2, 0, 0}}), 4 / 10.0);
  EXPECT_EQ(successive_ratio(along_x({7, 7, 7}), {.first = 0, .count = 3, .mean_mm = {7, 0, 0}}), 0);
}

}  // namespace
}  // namespace orcart
