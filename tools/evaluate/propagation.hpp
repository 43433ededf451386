// The error that a point of the surface must be expected to have, from the errors of the parts.
#pragma once

#include <cmath>

#include "tools/evaluate/error_chain.hpp"

namespace orcart {

/// Along the surface, mm.
struct PredictedError {
  Eigen::Matrix2d covariance_mm2 = Eigen::Matrix2d::Zero();  ///< in the axes of tangents_of(normal)
  double rms_mm() const { return std::sqrt(covariance_mm2.trace()); }
  /// Whether an error lies in the ellipse that holds 95 % (chi-square of two degrees, 5.991).
  bool covers(const Eigen::Vector2d& error_mm) const;
};

/// What one standard deviation of each part moves, so that a point needs one look a part. Made once a set-up.
struct ErrorSpread {
  Eigen::Matrix<double, 6, 6> scope, reference, registration;  ///< columns: square roots of covariances
};

/// The lower triangular root of body_covariance().
Eigen::Matrix<double, 6, 6> body_spread(const std::vector<Eigen::Vector3d>& points_mm, double sigma_mm);

ErrorSpread spread_of(const EvaluationScene& scene, const ErrorModel& model,
                      const std::vector<Eigen::Vector3d>& fiducials_M_mm);

/// First-order propagation of the parts in `set` through the whole chain to the tangent plane (central
/// differences of one standard deviation). Nothing where a ray grazes the plane.
std::optional<PredictedError> predict(const EvaluationScene& scene, const ErrorModel& model,
                                      const ErrorSpread& spread, const Capture& capture,
                                      const Landmark& landmark, const ComponentSet& set = kAllComponents);

}  // namespace orcart
