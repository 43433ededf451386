// The three lens models: numbers by hand, round trips over the picture, and where each stops being
// one-to-one.
#include "realtime/optics/lens.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace orcart {
namespace {

Lens with_limit(Lens lens) {
  lens.max_angle_rad = largest_monotone_angle_rad(lens, 1.2);
  return lens;
}

Lens brown_lens() {
  return with_limit({.model = LensModel::brown,
                     .fx_px = 540,
                     .fy_px = 535,
                     .cx_px = 322,
                     .cy_px = 236,
                     .coefficients = {-0.38, 0.19, 0.0012, -0.0008, -0.03}});
}

Lens poly4_lens() {
  return with_limit({.model = LensModel::poly4,
                     .fx_px = 500,
                     .fy_px = 450,
                     .cx_px = 320,
                     .cy_px = 240,
                     .coefficients = {1e-4, 2e-7, 1e-9, 0, 0},
                     .distortion_centre_px = {326, 233}});
}

Lens fisheye_lens() {
  return with_limit({.model = LensModel::fisheye,
                     .fx_px = 380,
                     .fy_px = 380,
                     .cx_px = 319.5,
                     .cy_px = 239.5,
                     .coefficients = {-0.02, 0.004, -0.001, 0.0002, 0}});
}

TEST(BrownLens, ProjectsAsWorkedOutByHand) {
  const Lens lens{.fx_px = 100,
                  .fy_px = 200,
                  .cx_px = 10,
                  .cy_px = 20,
                  .coefficients = {0.1, 0.01, 0.001, 0.002, 0.0001},
                  .max_angle_rad = 1};
  // x = 0.5, y = -0.2: r2 = 0.29; radial = 1 + 0.029 + 0.000841 + 0.0000024389 = 1.0298434389.
  // x' = 0.51492171945 + 2(0.001)(-0.1) + 0.002(0.29 + 0.5) = 0.51630171945
  // y' = -0.20596868778 + 0.001(0.29 + 0.08) + 2(0.002)(-0.1) = -0.20599868778
  const auto pixel = project(lens, {1, -0.4, 2});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 100 * 0.51630171945 + 10, 1e-9);
  EXPECT_NEAR(pixel->y(), 200 * -0.20599868778 + 20, 1e-9);
}

TEST(Poly4Lens, MapsTheDistortedRadiusToTheCorrectedOne) {
  const Lens lens{.model = LensModel::poly4,
                  .fx_px = 100,
                  .fy_px = 100,
                  .coefficients = {1e-3, 1e-5, 1e-7, 0, 0},
                  .max_angle_rad = 1};
  // Distorted radius 50: 50 + 2.5 + 1.25 + 0.625 = 54.375 corrected.
  const auto pixel = project(lens, {0.54375, 0, 1});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 50, 1e-9);
  const auto direction = direction_of(lens, {0, 50});
  ASSERT_TRUE(direction);
  EXPECT_NEAR(direction->y() / direction->z(), 0.54375, 1e-12);
}

TEST(Poly4Lens, MeasuresTheRadiusInSquarePixels) {
  const Lens lens{.model = LensModel::poly4,
                  .fx_px = 100,
                  .fy_px = 50,
                  .coefficients = {1e-3, 1e-5, 1e-7, 0, 0},
                  .max_angle_rad = 1};
  // 25 rows are 50 square pixels, corrected to 54.375 of them.
  const auto direction = direction_of(lens, {0, 25});
  ASSERT_TRUE(direction);
  EXPECT_NEAR(direction->y() / direction->z(), 0.54375, 1e-12);
}

TEST(FisheyeLens, ProjectsAsWorkedOutByHand) {
  const Lens lens{.model = LensModel::fisheye,
                  .fx_px = 100,
                  .fy_px = 100,
                  .coefficients = {0.1, 0, 0, 0, 0},
                  .max_angle_rad = 1.2};
  // 45 degrees to the right: theta (1 + 0.1 theta^2) with theta = pi/4.
  const auto pixel = project(lens, {3, 0, 3});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 100 * 0.78539816339744831 * (1 + 0.1 * 0.61685027506808491), 1e-9);
  EXPECT_NEAR(pixel->y(), 0, 1e-12);
}

class EveryLens : public testing::TestWithParam<Lens> {};

TEST_P(EveryLens, ComesBackToThePixelOverTheWholePicture) {
  const Lens& lens = GetParam();
  int met = 0;
  for (int y = 0; y < 480; y += 7)
    for (int x = 0; x < 640; x += 7) {
      const auto direction = direction_of(lens, {x, y});
      if (!direction) continue;
      ++met;
      EXPECT_NEAR(direction->norm(), 1, 1e-14);
      const auto pixel = project(lens, 17 * *direction);
      ASSERT_TRUE(pixel) << x << ' ' << y;
      EXPECT_LT((*pixel - Eigen::Vector2d(x, y)).norm(), 1e-9) << x << ' ' << y;
    }
  EXPECT_EQ(met, 69 * 92);
}

TEST_P(EveryLens, ComesBackToTheDirectionUpToItsEdge) {
  const Lens& lens = GetParam();
  for (double angle = 0; angle <= lens.max_angle_rad; angle += lens.max_angle_rad / 64)
    for (double azimuth = 0.1; azimuth < 6.3; azimuth += 0.39) {
      const Eigen::Vector3d d(std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
                              std::cos(angle));
      const auto pixel = project(lens, d);
      ASSERT_TRUE(pixel);
      const auto back = direction_of(lens, *pixel);
      ASSERT_TRUE(back) << angle << ' ' << azimuth;
      EXPECT_LT((*back - d).norm(), 1e-8) << angle << ' ' << azimuth;
    }
}

TEST_P(EveryLens, SeesNothingBehindOrBeyondItsEdge) {
  const Lens& lens = GetParam();
  EXPECT_FALSE(project(lens, {0, 0, -1}));
  EXPECT_FALSE(project(lens, {0, 0, 0}));
  const double beyond = lens.max_angle_rad + 1e-6;
  EXPECT_FALSE(project(lens, {std::sin(beyond), 0, std::cos(beyond)}));
  EXPECT_FALSE(project(lens, {NAN, 0, 1}));
  EXPECT_FALSE(direction_of(lens, {NAN, 0}));
  EXPECT_FALSE(direction_of(lens, {1e9, 0}));
}

INSTANTIATE_TEST_SUITE_P(Models, EveryLens, testing::Values(brown_lens(), poly4_lens(), fisheye_lens()),
                         [](const auto& each) {
                           return each.param.model == LensModel::brown   ? "brown"
                                  : each.param.model == LensModel::poly4 ? "poly4"
                                                                         : "fisheye";
                         });

TEST(LargestMonotoneAngle, IsTheLimitForAPinhole) {
  EXPECT_DOUBLE_EQ(largest_monotone_angle_rad({.fx_px = 1, .fy_px = 1}, 1.1), 1.1);
}

TEST(LargestMonotoneAngle, EndsWhereBrownFolds) {
  // r (1 - r^2/3) turns at r = 1: 45 degrees.
  const Lens lens{.fx_px = 1, .fy_px = 1, .coefficients = {-1.0 / 3, 0, 0, 0, 0}};
  const double angle = largest_monotone_angle_rad(lens, 1.5);
  EXPECT_LE(angle, M_PI / 4);
  EXPECT_NEAR(angle, M_PI / 4, 1e-3);
}

TEST(LargestMonotoneAngle, EndsWhereDecentringFoldsBrown) {
  const Lens lens{.fx_px = 1, .fy_px = 1, .coefficients = {0, 0, 0.25, 0, 0}};
  // d/dy of y + p1 (r2 + 2 y^2) is 1 + 6 p1 y: zero at y = -2/3.
  EXPECT_NEAR(largest_monotone_angle_rad(lens, 1.5), std::atan(2.0 / 3), 2e-3);
}

TEST(LargestMonotoneAngle, EndsWherePoly4Folds) {
  // r - r^3/30000 turns at r = 100, corrected 66.67; the centre lies 10 px off the axis.
  const Lens lens{.model = LensModel::poly4,
                  .fx_px = 100,
                  .fy_px = 100,
                  .coefficients = {0, -1.0 / 30000, 0, 0, 0},
                  .distortion_centre_px = {10, 0}};
  EXPECT_NEAR(largest_monotone_angle_rad(lens, 1.5), std::atan((200.0 / 3 - 10) / 100), 1e-9);
}

TEST(LargestMonotoneAngle, EndsWhereTheFisheyeFolds) {
  // theta (1 - theta^2/3) turns at theta = 1.
  const Lens lens{
      .model = LensModel::fisheye, .fx_px = 1, .fy_px = 1, .coefficients = {-1.0 / 3, 0, 0, 0, 0}};
  EXPECT_NEAR(largest_monotone_angle_rad(lens, 1.5), 1, 1e-3);
}

TEST(Poly4Lens, GivesNoDirectionToAPixelBeyondItsFold) {
  const Lens lens = with_limit(
      {.model = LensModel::poly4, .fx_px = 100, .fy_px = 100, .coefficients = {0, -1.0 / 30000, 0, 0, 0}});
  EXPECT_TRUE(direction_of(lens, {99, 0}));
  EXPECT_FALSE(
      direction_of(lens, {130, 0}));  // its corrected radius, 56.8, belongs to a pixel before the fold
}

}  // namespace
}  // namespace orcart
