// A scope at a turn is the scope at turn 0 whose picture went round: for every lens, angle of view and turn.
#include "realtime/optics/scope_turn.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace orcart {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A scope that looks `view_deg` off its shaft. S has its z axis along the shaft, towards the tip.
ScopeModel scope_of(LensModel model, double view_deg, TurnMarker marker) {
  ScopeModel scope{.width_px = 640, .height_px = 480};
  scope.lens = {.model = model, .fx_px = 340, .fy_px = 320, .cx_px = 324, .cy_px = 236};
  if (model == LensModel::brown) scope.lens.coefficients = {-0.26, 0.07, 0.003, -0.002, 0};
  if (model == LensModel::fisheye) scope.lens.coefficients = {-0.03, 0.01, 0, 0, 0};
  if (model == LensModel::poly4) {
    scope.lens.coefficients = {2e-4, 3e-7, 1e-9, 0, 0};
    scope.lens.distortion_centre_px = {318, 241};
  }
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.3);
  scope.mask = {.cx_px = 321, .cy_px = 239, .radius_px = 222};
  scope.X_SC.rotation = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(view_deg * kDegree, Eigen::Vector3d::UnitX()))
                            .toRotationMatrix();
  scope.X_SC.translation_mm = {6, -48, 262};
  scope.X_CE.translation_mm = {0.2, -0.1, 1};
  scope.notch_rad = 0.3;
  scope.turning = Turning{.view_angle_rad = view_deg * kDegree,
                          .centre_px = {317, 244},
                          .marker = marker,
                          .axis = Eigen::Vector3d::UnitZ(),
                          .axis_point_mm = {5.5, -47, 0}};
  return scope;
}

/// Round the coupler's centre, on a sensor whose pixels are fy/fx as high as wide.
Eigen::Vector2d gone_round(const Eigen::Vector2d& pixel, double turn_rad) {
  const double aspect = 320.0 / 340.0, dx = pixel.x() - 317, dy = (pixel.y() - 244) / aspect;
  return {317 + std::cos(turn_rad) * dx - std::sin(turn_rad) * dy,
          244 + aspect * (std::sin(turn_rad) * dx + std::cos(turn_rad) * dy)};
}

class EveryScope : public ::testing::TestWithParam<std::tuple<LensModel, double, TurnMarker>> {};

TEST_P(EveryScope, KnowsItsShaftAtEveryTurn) {
  const auto [model, view_deg, marker] = GetParam();
  ScopeModel scope = scope_of(model, view_deg, marker);
  scope.turning->R_SL = Eigen::Matrix3d::Identity();  // a second marker: the axis was calibrated
  for (const double turn_deg : {-180.0, -75.0, 0.0, 12.0, 90.0}) {
    const TurnedOptics at = optics_at(scope, turn_deg * kDegree);
    const auto shaft = shaft_of(scope, at);
    ASSERT_TRUE(shaft);
    EXPECT_NEAR(std::acos(shaft->z()), view_deg * kDegree, 1e-6) << turn_deg;
    // Under a marker on the head the shaft stays; with one on it C turns about its own axis: in C it goes
    // round as the picture does, either way.
    const Eigen::Vector3d expected = Eigen::AngleAxisd(turn_deg * kDegree, Eigen::Vector3d::UnitZ()) *
                                     *shaft_of(scope, optics_at(scope, 0));
    EXPECT_LT((*shaft - expected).norm(), 1e-9) << turn_deg;
  }
}

TEST(Shaft, IsNotToldByAPassportThatDoesNotKnowIt) {
  const ScopeModel angled = scope_of(LensModel::brown, 30, TurnMarker::shaft);
  EXPECT_FALSE(shaft_of(angled, optics_at(angled, 0.5)));
  const ScopeModel straight{};
  EXPECT_EQ(shaft_of(straight, optics_at(straight, 0)), Eigen::Vector3d::UnitZ());
}

TEST_P(EveryScope, SeesAtATurnWhatWentRound) {
  const auto [model, view_deg, marker] = GetParam();
  const ScopeModel scope = scope_of(model, view_deg, marker);
  for (const double turn_deg : {-180.0, -75.0, 0.0, 12.0, 90.0, 140.0}) {
    const double turn = turn_deg * kDegree;
    const TurnedOptics at = optics_at(scope, turn);
    for (const double x : {-9.0, 0.0, 7.0})
      for (const double y : {-8.0, 1.0, 6.0}) {
        const Point<S> on_shaft = scope.X_SC * Point<C>{{x, y, 20}};
        const auto at_zero = project(scope.lens, {x, y, 20});
        ASSERT_TRUE(at_zero);
        // The optics turn under a marker on the head: what they saw at turn 0 they see after the swing.
        Point<S> seen = on_shaft;
        if (marker == TurnMarker::head) {
          const Eigen::Vector3d foot(5.5, -47, 0);
          seen.mm = foot + Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * (on_shaft.mm - foot);
        }
        const auto pixel = project(at.lens, (at.X_SC.inverse() * seen).mm);
        ASSERT_TRUE(pixel);
        EXPECT_LT((*pixel - gone_round(*at_zero, turn)).norm(), 1e-8);
      }
    const Eigen::Vector2d mask = gone_round({321, 239}, turn);
    EXPECT_NEAR(at.mask.cx_px, mask.x(), 1e-9);
    EXPECT_NEAR(at.mask.cy_px, mask.y(), 1e-9);
    // The window stays where it is on the scope.
    const Eigen::Vector3d before = (scope.X_SC * scope.X_CE).translation_mm;
    if (marker == TurnMarker::shaft) {
      EXPECT_LT(((at.X_SC * at.X_CE).translation_mm - before).norm(), 1e-9);
    }
    EXPECT_NEAR(std::remainder(*turned(scope, turn).notch_rad - 0.3 - turn, 2 * std::numbers::pi), 0, 1e-9);
  }
}

TEST_P(EveryScope, ItsCovariancesGoRoundWithIt) {
  const auto [model, view_deg, marker] = GetParam();
  ScopeModel scope = scope_of(model, view_deg, marker);
  const double turn = 75 * kDegree;
  Twist twist;
  twist << 0.02, -0.03, 0.01, 1e-4, -2e-4, 3e-4;
  LensStep step = LensStep::Zero();
  step[2] = 0.02, step[3] = -0.03;
  if (model == LensModel::brown) step[6] = 1e-5, step[7] = -2e-5;
  if (model == LensModel::poly4) step[9] = 0.01, step[10] = 0.03;
  // Of one direction only, so that what comes out tells the one that it became.
  scope.hand_eye_covariance = twist * twist.transpose();
  scope.lens_covariance = step * step.transpose();
  const Eigen::Vector3d window_off(0.02, -0.05, 0.3);
  scope.window_covariance = window_off * window_off.transpose();
  ScopeModel wrong = scope;
  wrong.X_SC = moved(scope.X_SC, twist);
  wrong.X_CE.translation_mm += window_off;
  wrong.lens = stepped(scope.lens, step);
  const ScopeModel at = turned(scope, turn), wrong_at = turned(wrong, turn);
  const Pose<C, C> off = at.X_SC.inverse() * wrong_at.X_SC;
  const Eigen::AngleAxisd off_turn(off.rotation);
  Twist became;
  became << off.translation_mm, off_turn.angle() * off_turn.axis();
  const Eigen::Vector3d window_became = wrong_at.X_CE.translation_mm - at.X_CE.translation_mm;
  EXPECT_TRUE(at.window_covariance->isApprox(window_became * window_became.transpose(), 1e-9));
  EXPECT_TRUE(at.hand_eye_covariance->isApprox(became * became.transpose(), 1e-5));
  LensStep lens_became = LensStep::Zero();
  lens_became[2] = wrong_at.lens.cx_px - at.lens.cx_px, lens_became[3] = wrong_at.lens.cy_px - at.lens.cy_px;
  for (int i = 0; i < 5; ++i)
    lens_became[4 + i] = wrong_at.lens.coefficients[static_cast<std::size_t>(i)] -
                         at.lens.coefficients[static_cast<std::size_t>(i)];
  lens_became.tail<2>() = wrong_at.lens.distortion_centre_px - at.lens.distortion_centre_px;
  EXPECT_TRUE(at.lens_covariance->isApprox(lens_became * lens_became.transpose(), 1e-6));
}

INSTANTIATE_TEST_SUITE_P(ScopeTurn, EveryScope,
                         ::testing::Combine(::testing::Values(LensModel::brown, LensModel::poly4,
                                                              LensModel::fisheye),
                                            ::testing::Values(0.0, 30.0, 45.0, 70.0),
                                            ::testing::Values(TurnMarker::shaft, TurnMarker::head)));

TEST(ScopeTurn, OfAStraightScopeUnderItsHeadMovesNothingButTheCentre) {
  ScopeModel scope = scope_of(LensModel::fisheye, 0, TurnMarker::head);
  scope.turning->centre_px = {scope.lens.cx_px, scope.lens.cy_px};
  scope.turning->axis_point_mm = scope.X_SC.translation_mm;
  const TurnedOptics at = optics_at(scope, 1.1);
  EXPECT_TRUE(at.X_SC.rotation.isApprox(scope.X_SC.rotation, 1e-12));
  EXPECT_LT((at.X_SC.translation_mm - scope.X_SC.translation_mm).norm(), 1e-9);
}

TEST(ScopeTurn, WithoutTurningIsThePassportAsItIs) {
  ScopeModel scope = scope_of(LensModel::brown, 30, TurnMarker::shaft);
  scope.turning.reset();
  const TurnedOptics at = optics_at(scope, 1.1);
  EXPECT_EQ(at.lens.cx_px, scope.lens.cx_px);
  EXPECT_EQ(at.X_SC.rotation, scope.X_SC.rotation);
}

class EveryMarker : public ::testing::TestWithParam<TurnMarker> {};

TEST_P(EveryMarker, ASecondMarkerTellsTheTurnThatTheOpticsAreAt) {
  ScopeModel scope = scope_of(LensModel::brown, 30, GetParam());
  Turning& turning = *scope.turning;
  turning.axis = Eigen::Vector3d(0.1, -0.2, 1).normalized();
  turning.R_SL = Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (const double turn_deg : {-179.0, -75.0, 0.0, 12.0, 90.0, 170.0}) {
    const MarkedTurn told = turn_of(turning, second_marker_at(turning, turn_deg * kDegree));
    EXPECT_NEAR(told.turn_rad, turn_deg * kDegree, 1e-12);
    EXPECT_NEAR(told.swing_rad, 0, 1e-7);
  }
  if (GetParam() == TurnMarker::shaft) return;
  // S on the head: the second one is on the shaft and stands still beside the optics.
  for (const double turn : {-1.0, 0.4, 2.5}) {
    const Eigen::Matrix3d sensor = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Matrix3d optics = optics_at(scope, turn).X_SC.rotation * sensor;
    EXPECT_TRUE((second_marker_at(turning, turn).transpose() * optics)
                    .isApprox(turning.R_SL->transpose() * scope.X_SC.rotation, 1e-12));
  }
}

TEST_P(EveryMarker, ASecondMarkerThatWasBentShowsAsSwing) {
  Turning turning = *scope_of(LensModel::brown, 30, GetParam()).turning;
  turning.R_SL = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d bent = Eigen::AngleAxisd(8 * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const MarkedTurn told = turn_of(turning, bent * second_marker_at(turning, 0.5));
  EXPECT_NEAR(told.swing_rad, 8 * kDegree, 1e-9);
  EXPECT_NEAR(told.turn_rad, 0.5, 1e-9);
}

TEST_P(EveryMarker, ATurnedPassportCountsItsSecondMarkerFromTheNewZero) {
  ScopeModel scope = scope_of(LensModel::brown, 30, GetParam());
  scope.turning->R_SL = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const ScopeModel at = turned(scope, 0.6);
  EXPECT_NEAR(turn_of(*at.turning, second_marker_at(*scope.turning, 0.9)).turn_rad, 0.3, 1e-12);
}
INSTANTIATE_TEST_SUITE_P(ScopeTurn, EveryMarker, ::testing::Values(TurnMarker::shaft, TurnMarker::head));

}  // namespace
}  // namespace orcart
