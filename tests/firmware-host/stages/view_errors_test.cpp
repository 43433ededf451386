// One view's predicted error where it can be worked out by hand, and that it asks nothing of the heap.
#include "firmware-host/stages/view_errors.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

/// A pinhole that leaves nothing open.
ScopeModel exact_scope() {
  ScopeModel scope{.name = "pinhole", .width_px = 640, .height_px = 480};
  scope.lens = {.fx_px = 340, .fy_px = 340, .cx_px = 320, .cy_px = 240, .max_angle_rad = 1.2};
  scope.mask = {.cx_px = 320, .cy_px = 240, .radius_px = 200};
  scope.cone_half_angle_rad = 1e-6;  // all directions are the axis
  scope.X_SC.translation_mm = {0, 0, 250};
  scope.lens_covariance = LensCovariance::Zero();
  scope.hand_eye_covariance = TwistCovariance::Zero();
  return scope;
}

ChainErrors nothing() {
  return {.marker_rms_mm = 0, .registration = TwistCovariance::Zero(), .time_s = 0, .texel_mm = 0};
}

TEST(ViewErrors, OfAnExactChainIsThePicturesAlone) {
  const ViewError error = ViewErrors(exact_scope(), {}, nothing()).at({});
  EXPECT_NEAR(error.position_mm, 0, 1e-6);
  EXPECT_NEAR(error.angle_rad, 0, 1e-6);
  EXPECT_NEAR(error.pixels, std::numbers::sqrt2 * kAssumedErrors.picture_px, 1e-5);
}

TEST(ViewErrors, OfARegistrationKnownByItsTargetErrorAloneAreTwoOfThreeAxes) {
  ChainErrors chain = nothing();
  chain.registration.reset();
  chain.registration_mm = 0.6;
  EXPECT_NEAR(ViewErrors(exact_scope(), {}, chain).at({}).position_mm, 0.6 * std::sqrt(2.0 / 3), 1e-6);
}

TEST(ViewErrors, OfARegistrationThatTurnsGrowWithTheWayFromTheReference) {
  ChainErrors chain = nothing();
  (*chain.registration)(3, 3) = 1e-6;  // 1 mrad about R's x
  const ViewErrors errors(exact_scope(), {}, chain);
  Pose<M, C> near, far;
  near.translation_mm = {0, 0, 50};
  far.translation_mm = {0, 0, 150};
  const auto at_20_mm = [](const ViewError& e) {
    return std::hypot(static_cast<double>(e.position_mm), 20.0 * static_cast<double>(e.angle_rad));
  };
  EXPECT_NEAR(at_20_mm(errors.at(near)), 0.070, 0.001);
  EXPECT_NEAR(at_20_mm(errors.at(far)), 0.170, 0.001);
}

TEST(ViewErrors, OfTheHandEyeAreThePassports) {
  ScopeModel scope = exact_scope();
  scope.hand_eye_covariance->diagonal() << 0.09, 0.16, 4, 1e-6, 1e-6, 1;  // along and about the axis: unseen
  const ViewError error = ViewErrors(scope, {}, nothing()).at({});
  EXPECT_NEAR(error.position_mm, 0.5, 1e-4);
  EXPECT_NEAR(error.angle_rad, std::sqrt(2e-6), 1e-5);
}

TEST(ViewErrors, OfTheScopesMarkersActOverTheLeverToTheTip) {
  ChainErrors chain = nothing();
  chain.marker_rms_mm = 0.12;
  chain.scope_markers_mm = {{30, 0, 0}, {-30, 0, 0}, {0, 30, 0}, {0, -30, 0}};
  chain.reference_markers_mm = {{1e6, 0, 0}, {-1e6, 0, 0}, {0, 1e6, 0}, {0, -1e6, 0}};  // turns by nothing
  const ViewError error = ViewErrors(exact_scope(), {}, chain).at({});
  // Each axis: 0.12 / sqrt 3 a marker; a turn about x or y: over sqrt(2 30^2); twice a place: over sqrt 4.
  const double sigma = 0.12 / std::numbers::sqrt3, turn = sigma / std::sqrt(1800.0), place = sigma / 2;
  const double at_15 = std::sqrt(2 * turn * turn * 265 * 265 + 4 * place * place);
  EXPECT_NEAR(std::hypot(static_cast<double>(error.position_mm), 15.0 * static_cast<double>(error.angle_rad)),
              at_15, 1e-4);
}

ScopeModel turning_scope() {
  ScopeModel scope = exact_scope();
  scope.turning = Turning{.centre_px = {320 - 34, 240}};  // a tenth of the focal length beside the lens's own
  return scope;
}

TEST(ViewErrors, OfALightPostSwingWhatLiesBesideItsCentre) {
  ChainErrors chain = nothing();
  chain.light_post_rad = 0.01;
  const ViewError error = ViewErrors(turning_scope(), {}, chain).at({});
  EXPECT_NEAR(error.position_mm, 0, 1e-6);
  EXPECT_NEAR(error.angle_rad, 0.01 * 0.1, 1e-7);
}

TEST(ViewErrors, OfALightPostGrowTowardsThePicturesEdge) {
  ScopeModel scope = turning_scope();
  scope.turning->centre_px = {320, 240};
  scope.cone_half_angle_rad = 0.6;
  ChainErrors chain = nothing();
  const double without = static_cast<double>(ViewErrors(scope, {}, chain).at({}).angle_rad);
  chain.light_post_rad = 0.01;
  const double with = static_cast<double>(ViewErrors(scope, {}, chain).at({}).angle_rad);
  // Four of five directions, at two thirds of the cone.
  EXPECT_NEAR(std::sqrt(with * with - without * without), 0.01 * std::sin(0.4) * std::sqrt(0.8), 1e-6);
}

TEST(ViewErrors, OfALightPostUnderAMarkerOnTheHeadActOverTheWayToTheShaft) {
  ScopeModel scope = turning_scope();
  scope.turning = Turning{.centre_px = {320, 240}, .marker = TurnMarker::head, .axis_point_mm = {5, 0, 0}};
  ChainErrors chain = nothing();
  chain.light_post_rad = 0.01;
  EXPECT_NEAR(ViewErrors(scope, {}, chain).at({}).position_mm, 5 * 0.01, 1e-6);
  EXPECT_EQ(ViewErrors(exact_scope(), {}, chain).at({}).position_mm,
            ViewErrors(exact_scope(), {}, nothing()).at({}).position_mm)
      << "a scope in one piece has no light post to turn";
}

TEST(MarkedTurn, IsOffByBothBodiesTurnsAboutTheShaft) {
  const std::vector<Eigen::Vector3d> markers{{30, 0, 0}, {-30, 0, 0}, {0, 30, 0}, {0, -30, 0}};
  // About z: each marker's two axes across, over four times 30^2; about x: two markers, over 2 times 30^2.
  const double sigma = 0.12 / std::numbers::sqrt3, z = sigma / 60, x = sigma / std::sqrt(1800.0);
  Turning turning;
  EXPECT_NEAR(marked_turn_deviation_rad(turning, markers, markers, 0.12), std::hypot(z, z), 1e-9);
  turning.R_SL = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_NEAR(marked_turn_deviation_rad(turning, markers, markers, 0.12), std::hypot(z, x), 1e-9);
}

TEST(ViewErrors, AskNothingOfTheHeap) {
  const ViewErrors errors(exact_scope(), {}, {});
  const Pose<M, C> X_MC;
  ViewError error;
  EXPECT_TRUE(testing::zero_allocation([&] { error = errors.at(X_MC); }));
  EXPECT_GT(error.position_mm, 0.1F);
}

}  // namespace
}  // namespace orcart
