// Air to fluid at a flat window: the error of leaving it out is the published one, and the conversion takes
// it away.
#include "tools/calibration/medium.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/tools/calibration/simulated_board.hpp"
#include "tools/calibration/mask_finder.hpp"

namespace orcart {
namespace {

ScopeModel in_air(LensModel model) {
  ScopeModel scope{.width_px = 640, .height_px = 480, .lens = testing::test_lens(model)};
  scope.mask = {.cx_px = 322, .cy_px = 250, .radius_px = 215};
  scope.X_CE.translation_mm.z() = 1.5;
  scope.X_SC.translation_mm = {3, 4, 200};
  scope.residual_px = 0.3, scope.residual_mm = 0.5;
  return scope;
}

/// A pixel that sees `angle` off the axis in air.
Eigen::Vector2d pixel_at(const ScopeModel& scope, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return *project(scope.lens, {std::sin(angle), 0, std::cos(angle)});
}

TEST(Medium, LeavingRefractionOutIsWrongByTwoAndFourAndAHalfMillimetres) {
  ScopeModel scope = in_air(LensModel::fisheye);
  scope.X_CE.translation_mm.z() = 0;
  for (const auto& [degrees, wrong_mm] : {std::pair{20.0, 1.96}, std::pair{35.0, 4.47}}) {
    const auto seen = seen_in_fluid(scope, pixel_at(scope, degrees), refractive_index(Medium::water), 20);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(20 * std::tan(degrees * std::numbers::pi / 180) - seen->x(), wrong_mm, 0.03);
  }
}

TEST(Medium, TheHandEyesCovarianceMovesWithTheOpticalCentreAndTheLensesIsForgotten) {
  ScopeModel air = in_air(LensModel::brown);
  air.lens_covariance = LensCovariance::Identity();
  air.hand_eye_covariance = TwistCovariance::Zero();
  (*air.hand_eye_covariance)(4, 4) = 1e-4;  // a turn about y alone
  air.window_covariance = Eigen::Vector3d(0, 0, 0.04).asDiagonal();
  const auto fluid = to_fluid(air, Medium::water, {});
  ASSERT_TRUE(fluid) << fluid.error().message;
  EXPECT_FALSE(fluid->scope.lens_covariance);
  EXPECT_NEAR((*fluid->scope.window_covariance)(2, 2), 1.333 * 1.333 * 0.04, 1e-12);
  const TwistCovariance& moved = *fluid->scope.hand_eye_covariance;
  EXPECT_NEAR(std::sqrt(moved(0, 0)), 0.01 * fluid->viewpoint_mm, 1e-12);  // swings C, which lies back
  EXPECT_NEAR(moved(4, 4), 1e-4, 1e-16);
}

TEST(Medium, AConvertedPassportSeesWhatThePixelsSeeInFluid) {
  for (const LensModel model : {LensModel::brown, LensModel::poly4, LensModel::fisheye}) {
    const ScopeModel air = in_air(model);
    const auto fluid = to_fluid(air, Medium::saline, {});
    ASSERT_TRUE(fluid) << fluid.error().message;
    EXPECT_EQ(fluid->scope.medium, Medium::saline);
    EXPECT_LT(fluid->viewpoint_rms_px, 0.8);  // 0.56 to 0.67: what one viewpoint leaves between 5 and 60 mm
    EXPECT_LT(fluid->added_mm, 0.25);
    EXPECT_GT(fluid->added_px, fluid->viewpoint_rms_px);
    EXPECT_GT(fluid->scope.residual_px, air.residual_px);
    // The distal window stays where it is on the marker, though C moves.
    EXPECT_TRUE((fluid->scope.X_SC * fluid->scope.X_CE)
                    .translation_mm.isApprox((air.X_SC * air.X_CE).translation_mm));
    const auto seen = seen_in_fluid(air, {400, 300}, refractive_index(Medium::saline), 20);
    const Pose<C, C> back = air.X_SC.inverse() * fluid->scope.X_SC;
    const auto again = project(fluid->scope.lens, *seen - back.translation_mm);
    ASSERT_TRUE(again);
    EXPECT_LT((*again - Eigen::Vector2d(400, 300)).norm(), 0.5);
  }
}

TEST(Medium, RefusesWhatItCannotConvert) {
  ScopeModel scope = in_air(LensModel::brown);
  EXPECT_NE(to_fluid(scope, Medium::air, {}).error().message.find("air to air"), std::string::npos);
  scope.X_CE = {};
  EXPECT_NE(to_fluid(scope, Medium::water, {}).error().message.find("calibrate tip"), std::string::npos);
  scope.medium = Medium::water;
  EXPECT_NE(to_fluid(scope, Medium::saline, {}).error().message.find("not made in air"), std::string::npos);
}

}  // namespace
}  // namespace orcart
