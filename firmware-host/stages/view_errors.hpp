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
  double texel_mm = 0.2;
};

/// First-order propagation to across the line of sight: X_MC = X_MR X_RT X_TS X_SC, each factor with its
/// covariance as a twist, seen from C. Made before arming; at() costs two products of 6x6 matrices and five
/// directions, whatever the view. A body whose markers are not known counts as four, 45 mm from their middle.
class ViewErrors {
 public:
  ViewErrors(const ScopeModel& scope, const Pose<M, R>& X_MR, const ChainErrors& chain);

  /// Any thread. RMS across the line of sight, over both axes, of what pose, lens, medium, time and picture
  /// leave open; averaged over the middle of the picture and four directions at two thirds of the cone.
  ViewError at(const Pose<M, C>& X_MC) const noexcept;

 private:
  Pose<R, M> X_RM_;
  TwistCovariance in_R_;  ///< reference body and registration
  TwistCovariance in_C_;  ///< scope body, hand-eye and time
  std::array<Eigen::Vector3d, 5> directions_;
  double grain2_mm2_ = 0, bend2_rad2_ = 0, pixels_ = 0;
};

}  // namespace orcart
