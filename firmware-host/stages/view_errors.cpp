// Everything that no pose changes is summed once; a view adds what swings about the reference.
#include "firmware-host/stages/view_errors.hpp"

#include <cmath>
#include <numbers>

#include "realtime/optics/scope_turn.hpp"
#include "realtime/registration/body_covariance.hpp"

namespace orcart {
namespace {

const std::array<Eigen::Vector3d, 4> kUnknownBody{Eigen::Vector3d{45, 0, 0}, Eigen::Vector3d{0, 45, 0},
                                                  Eigen::Vector3d{-45, 0, 0}, Eigen::Vector3d{0, -45, 0}};

TwistCovariance of_body(const std::vector<Eigen::Vector3d>& markers_mm, double marker_rms_mm) {
  const double sigma_mm = marker_rms_mm / std::numbers::sqrt3;
  return markers_mm.size() < 3 ? body_covariance(kUnknownBody, sigma_mm)
                               : body_covariance(markers_mm, sigma_mm);
}

/// Alike in all directions; `mm` and `rad` a single axis's.
TwistCovariance alike(double mm, double rad) {
  TwistCovariance covariance = TwistCovariance::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(mm * mm), Eigen::Vector3d::Constant(rad * rad);
  return covariance;
}

TwistCovariance of_registration(const ChainErrors& chain) {
  return chain.registration.value_or(alike(chain.registration_mm / std::numbers::sqrt3, 0));
}

/// Of a pixel, each axis, at a part of the cone.
double lens_px(const ScopeModel& scope, double part) {
  const double angle = part * scope.cone_half_angle_rad;
  if (scope.lens_covariance) return lens_deviation_px(scope.lens, *scope.lens_covariance, angle);
  constexpr AssumedErrors a = kAssumedErrors;
  // Radial parts count half an axis.
  const double focal_px = a.lens_focal * scope.lens.fx_px * std::tan(angle),
               edge_px = a.lens_edge_px * part * part * part;
  return std::sqrt(a.lens_centre_px * a.lens_centre_px + (focal_px * focal_px + edge_px * edge_px) / 2);
}

Eigen::Matrix3d across_line(const Eigen::Vector3d& direction) noexcept {
  return Eigen::Matrix3d::Identity() - direction * direction.transpose();
}

}  // namespace

double marked_turn_deviation_rad(const Turning& turning, const std::vector<Eigen::Vector3d>& scope_markers_mm,
                                 const std::vector<Eigen::Vector3d>& second_markers_mm,
                                 double marker_rms_mm) {
  const Eigen::Vector3d in_L = turning.R_SL.value_or(Eigen::Matrix3d::Identity()).transpose() * turning.axis;
  const auto about = [&](const std::vector<Eigen::Vector3d>& markers_mm, const Eigen::Vector3d& axis) {
    return axis.dot(of_body(markers_mm, marker_rms_mm).bottomRightCorner<3, 3>() * axis);
  };
  return std::sqrt(about(scope_markers_mm, turning.axis) + about(second_markers_mm, in_L));
}

ViewErrors::Across ViewErrors::across(const TwistCovariance& covariance,
                                      const Eigen::Vector3d& direction) noexcept {
  const Eigen::Matrix3d flat = across_line(direction), swing = cross_matrix(direction);
  return {.position = (flat * covariance.topLeftCorner<3, 3>()).trace(),
          .mixed = (flat * covariance.topRightCorner<3, 3>() * swing).trace(),
          .turn = (swing * covariance.bottomRightCorner<3, 3>() * swing.transpose()).trace()};
}

ViewErrors::Across ViewErrors::of_light_post(const ScopeModel& scope, double light_post_rad) const {
  constexpr double kStep_rad = 1e-4;
  Across mean;
  if (!scope.turning || light_post_rad == 0) return mean;
  for (const Eigen::Vector3d& direction : directions_) {
    const auto pixel = project(scope.lens, direction);
    if (!pixel) continue;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero(), ray = Eigen::Vector3d::Zero();
    bool seen = true;
    for (const double side : {1.0, -1.0}) {
      const TurnedOptics optics = optics_at(scope, side * kStep_rad);
      const Pose<C, C> X_CC = scope.X_SC.inverse() * optics.X_SC;
      const auto in_turned = direction_of(optics.lens, *pixel);
      seen = seen && in_turned;
      const double part = side * light_post_rad / (2 * kStep_rad);
      origin += part * X_CC.translation_mm;
      if (in_turned) ray += part * (X_CC.rotation * *in_turned);
    }
    if (!seen) continue;
    const Eigen::Vector3d aside = across_line(direction) * origin;
    mean.position += aside.squaredNorm() / 5, mean.mixed += aside.dot(ray) / 5;
    mean.turn += ray.squaredNorm() / 5;
  }
  return mean;
}

ViewErrors::ViewErrors(const ScopeModel& scope, const Pose<M, R>& X_MR, const ChainErrors& chain)
    : X_RM_(X_MR.inverse()) {
  constexpr AssumedErrors a = kAssumedErrors;
  constexpr double kPart = 2.0 / 3;
  in_R_ = of_body(chain.reference_markers_mm, chain.marker_rms_mm) + of_registration(chain);
  in_C_ = covariance_seen_from(scope.X_SC, of_body(chain.scope_markers_mm, chain.marker_rms_mm)) +
          scope.hand_eye_covariance.value_or(alike(a.hand_eye_mm, a.hand_eye_rad)) +
          alike(chain.time_s * a.speed_mm_s / std::numbers::sqrt3,
                chain.time_s * a.turn_rad_s / std::numbers::sqrt3);
  const double aside = std::sin(kPart * scope.cone_half_angle_rad),
               ahead = std::cos(kPart * scope.cone_half_angle_rad);
  directions_ = {Eigen::Vector3d{0, 0, 1}, Eigen::Vector3d{aside, 0, ahead},
                 Eigen::Vector3d{-aside, 0, ahead}, Eigen::Vector3d{0, aside, ahead},
                 Eigen::Vector3d{0, -aside, ahead}};
  light_post_ = of_light_post(scope, chain.light_post_rad);
  grain2_mm2_ = chain.texel_mm * chain.texel_mm / 6;  // evenly within a texel, both axes
  bend2_rad2_ = std::pow(a.refraction * aside / ahead, 2);
  pixels_ = std::numbers::sqrt2 * std::hypot(lens_px(scope, kPart), a.picture_px);
}

ViewError ViewErrors::at(const Pose<M, C>& X_MC) const noexcept {
  const TwistCovariance covariance = in_C_ + covariance_seen_from(X_RM_ * X_MC, in_R_);
  Across mean = light_post_;
  for (const Eigen::Vector3d& direction : directions_) {
    const Across one = across(covariance, direction);
    mean.position += one.position / 5, mean.mixed += one.mixed / 5, mean.turn += one.turn / 5;
  }
  // The painter's form has no mixed term: it is shared out so that value and slope are right at a usual
  // distance.
  constexpr double kUsual_mm = 15;
  double position2 = mean.position + mean.mixed * kUsual_mm, turn2 = mean.turn + mean.mixed / kUsual_mm;
  if (position2 < 0 || turn2 < 0) {
    position2 = mean.position + 2 * mean.mixed * kUsual_mm + mean.turn * kUsual_mm * kUsual_mm;
    turn2 = 0;
  }
  return {.position_mm = static_cast<float>(std::sqrt(position2 + grain2_mm2_)),
          .angle_rad = static_cast<float>(std::sqrt(turn2 + bend2_rad2_)),
          .pixels = static_cast<float>(pixels_)};
}

}  // namespace orcart
