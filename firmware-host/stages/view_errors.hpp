// How far one view's paint must be expected to be off, propagated from the parts of the chain, as the painter
// wants it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "firmware-host/stages/assumed_errors.hpp"
#include "realtime/geometry/twist.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/paint_settings.hpp"

namespace orcart {

/// What is known of the chain beside the passport.
struct ChainErrors {
  double marker_rms_mm = kAssumedErrors.marker_rms_mm;
  std::vector<Eigen::Vector3d> scope_markers_mm, reference_markers_mm;  ///< in S and R; empty: not known
  std::optional<TwistCovariance> registration;                          ///< of X_MR: a twist in R
  double registration_mm = 0;  ///< where that is not known: predicted TRE, RMS, alike everywhere
  double time_s = kAssumedErrors.time_s;
  double light_post_rad = 0;  ///< of an angled scope's turn, told or followed; nothing without [turning]
  double texel_mm = 0.2;
};

/// Standard deviation of a turn that is followed by two markers: both bodies' turns about the shaft's axis,
/// taken for independent of what else the scope's body does.
double marked_turn_deviation_rad(const Turning& turning, const std::vector<Eigen::Vector3d>& scope_markers_mm,
                                 const std::vector<Eigen::Vector3d>& second_markers_mm, double marker_rms_mm);

/// First-order propagation to across the line of sight: X_MC = X_MR X_RT X_TS X_SC, each factor with its
/// covariance as a twist, seen from C. Made before arming; at() costs two products of 6x6 matrices and five
/// directions, whatever the view. A body whose markers are not known counts as four, 45 mm from their middle.
class ViewErrors {
 public:
  ViewErrors(const ScopeModel& scope, const Pose<M, R>& X_MR, const ChainErrors& chain);

  /// Any thread. RMS across the line of sight, over both axes, of what pose, lens, medium, time, turn and
  /// picture leave open; averaged over the middle of the picture and four directions at two thirds of the
  /// cone.
  ViewError at(const Pose<M, C>& X_MC) const noexcept;

 private:
  /// Mean squares across the line of sight at distance d: position + 2 mixed d + turn d^2.
  struct Across {
    double position = 0, mixed = 0, turn = 0;
  };
  static Across across(const TwistCovariance& covariance, const Eigen::Vector3d& direction) noexcept;
  /// Of a turn that is off by so much: what becomes of the rays of the pixels that see the directions.
  Across of_light_post(const ScopeModel& scope, double light_post_rad) const;

  Pose<R, M> X_RM_;
  TwistCovariance in_R_;  ///< reference body and registration
  TwistCovariance in_C_;  ///< scope body, hand-eye and time
  std::array<Eigen::Vector3d, 5> directions_;
  Across light_post_;
  double grain2_mm2_ = 0, bend2_rad2_ = 0, pixels_ = 0;
};

}  // namespace orcart
