// Points of the sensor go round a centre; C goes round its own axis by as much.
#include "realtime/optics/scope_turn.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace orcart {
namespace {

/// Round the centre, in pixels made square by the lens's two focal lengths.
Eigen::Vector2d round_centre(const ScopeModel& scope, const Eigen::Vector2d& pixel, double turn_rad) {
  const double aspect = scope.lens.fy_px / scope.lens.fx_px;
  const Eigen::Vector2d& centre = scope.turning->centre_px;
  const double x = pixel.x() - centre.x(), y = (pixel.y() - centre.y()) / aspect;
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {centre.x() + c * x - s * y, centre.y() + aspect * (s * x + c * y)};
}

Eigen::Matrix3d about(const Eigen::Vector3d& axis, double turn_rad) {
  return Eigen::AngleAxisd(turn_rad, axis).toRotationMatrix();
}

/// What the turn makes of small steps in the lens's numbers: centres and Brown's decentring go round.
Eigen::Matrix<double, kLensNumbers, kLensNumbers> numbers_going_round(const Lens& lens, double turn_rad) {
  const double aspect = lens.fy_px / lens.fx_px, c = std::cos(turn_rad), s = std::sin(turn_rad);
  Eigen::Matrix<double, kLensNumbers, kLensNumbers> round;
  round.setIdentity();
  Eigen::Matrix2d place, decentring;
  place << c, -s / aspect, aspect * s, c;
  decentring << c, s, -s, c;  // of (p1, p2), where (p2, p1) is the vector
  round.block<2, 2>(2, 2) = place;
  round.block<2, 2>(9, 9) = place;
  if (lens.model == LensModel::brown) round.block<2, 2>(6, 6) = decentring;
  return round;
}

}  // namespace

TurnedOptics optics_at(const ScopeModel& scope, double turn_rad) noexcept {
  TurnedOptics optics{.lens = scope.lens,
                      .mask = scope.mask,
                      .X_SC = scope.X_SC,
                      .X_CE = scope.X_CE,
                      .notch_rad = scope.notch_rad};
  if (!scope.turning) return optics;
  if (optics.notch_rad) optics.notch_rad = std::remainder(*optics.notch_rad + turn_rad, 2 * M_PI);
  const Eigen::Vector2d middle = round_centre(scope, {scope.lens.cx_px, scope.lens.cy_px}, turn_rad);
  optics.lens.cx_px = middle.x(), optics.lens.cy_px = middle.y();
  if (scope.lens.model == LensModel::poly4)
    optics.lens.distortion_centre_px = round_centre(scope, scope.lens.distortion_centre_px, turn_rad);
  if (scope.lens.model == LensModel::brown) {
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    const double p1 = scope.lens.coefficients[2], p2 = scope.lens.coefficients[3];  // (p2, p1) is a vector
    optics.lens.coefficients[3] = c * p2 - s * p1;
    optics.lens.coefficients[2] = s * p2 + c * p1;
  }
  const Eigen::Vector2d mask = round_centre(scope, {scope.mask.cx_px, scope.mask.cy_px}, turn_rad);
  optics.mask.cx_px = mask.x(), optics.mask.cy_px = mask.y();
  const Pose<C, C> on_sensor{.rotation = about(Eigen::Vector3d::UnitZ(), turn_rad)};
  optics.X_SC = scope.X_SC * on_sensor.inverse();
  optics.X_CE = on_sensor * scope.X_CE;
  if (scope.turning->marker == TurnMarker::shaft) return optics;
  const Eigen::Matrix3d under_head = about(scope.turning->axis, turn_rad);
  const Eigen::Vector3d& point = scope.turning->axis_point_mm;
  const Pose<S, S> swung{.rotation = under_head, .translation_mm = point - under_head * point};
  optics.X_SC = swung * optics.X_SC;
  return optics;
}

std::optional<Eigen::Vector3d> shaft_of(const ScopeModel& scope, const TurnedOptics& at) noexcept {
  if (!scope.turning || scope.turning->view_angle_rad == 0) return Eigen::Vector3d::UnitZ();
  if (scope.turning->marker == TurnMarker::shaft && !scope.turning->R_SL) return std::nullopt;
  return at.X_SC.rotation.transpose() * scope.turning->axis;
}

MarkedTurn turn_of(const Turning& turning, const Eigen::Matrix3d& R_SL) noexcept {
  const Eigen::Quaterniond since(R_SL * turning.R_SL.value_or(Eigen::Matrix3d::Identity()).transpose());
  const double along = since.vec().dot(turning.axis);
  const double twist = std::remainder(2 * std::atan2(along, since.w()), 2 * M_PI);
  const double across = (since.vec() - along * turning.axis).norm();
  return {.turn_rad = turning.marker == TurnMarker::head ? twist : -twist,
          .swing_rad = 2 * std::asin(std::min(across, 1.0))};
}

Eigen::Matrix3d second_marker_at(const Turning& turning, double turn_rad) noexcept {
  return about(turning.axis, turning.marker == TurnMarker::head ? turn_rad : -turn_rad) *
         turning.R_SL.value_or(Eigen::Matrix3d::Identity());
}

ScopeModel turned(const ScopeModel& scope, double turn_rad) {
  const TurnedOptics optics = optics_at(scope, turn_rad);
  ScopeModel at = scope;
  if (scope.turning && scope.lens_covariance) {
    const Eigen::Matrix<double, kLensNumbers, kLensNumbers> round = numbers_going_round(scope.lens, turn_rad);
    at.lens_covariance = round * *scope.lens_covariance * round.transpose();
  }
  if (scope.turning && scope.hand_eye_covariance)
    at.hand_eye_covariance = covariance_seen_from(
        Pose<C, C>{.rotation = about(Eigen::Vector3d::UnitZ(), -turn_rad)}, *scope.hand_eye_covariance);
  if (scope.turning && scope.window_covariance) {
    const Eigen::Matrix3d round = about(Eigen::Vector3d::UnitZ(), turn_rad);
    at.window_covariance = round * *scope.window_covariance * round.transpose();
  }
  at.lens = optics.lens;
  at.mask = optics.mask;
  at.X_SC = optics.X_SC;
  at.X_CE = optics.X_CE;
  at.notch_rad = optics.notch_rad;
  if (scope.turning && scope.turning->R_SL) at.turning->R_SL = second_marker_at(*scope.turning, turn_rad);
  return at;
}

}  // namespace orcart
