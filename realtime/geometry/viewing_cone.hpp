// The viewing cone of a scope in mesh space, and the exact test of a triangle against it.
#pragma once

#include <array>

#include <Eigen/Core>

#include "realtime/geometry/pose.hpp"

namespace orcart {

/// All points within half_angle_rad of C's z axis and no deeper than far_mm along it: a convex solid.
struct ViewingCone {
  Eigen::Vector3f apex_mm = Eigen::Vector3f::Zero();   ///< C's origin, in M
  Eigen::Matrix3f R_CM = Eigen::Matrix3f::Identity();  ///< turns M's directions into C's
  float tangent = 1, sine = 0.70710678F,
        cosine = 0.70710678F;  ///< of the half angle, which is below 90 degrees
  float far_mm = 60;

  /// The same cone elsewhere.
  void aim(const Pose<M, C>& X_MC) noexcept {
    apex_mm = X_MC.translation_mm.cast<float>();
    R_CM = X_MC.rotation.transpose().cast<float>();
  }
  /// A point of M (mm) in C.
  Eigen::Vector3f to_camera(const Eigen::Vector3f& p_mm) const noexcept { return R_CM * (p_mm - apex_mm); }
};

struct ConeShape {
  double half_angle_rad = 0;  ///< above 0, below pi/2
  double far_mm = 0;
};

ViewingCone viewing_cone(const Pose<M, C>& X_MC, const ConeShape& shape) noexcept;

/// Whether a triangle (corners in C, mm) and the cone share a point. Exact up to rounding, also for triangles
/// without area. A triangle meets the convex cone where a corner lies inside, an edge crosses it, or the axis
/// pierces the triangle: a plane section that meets no edge is an ellipse about the axis. The far plane cuts
/// the triangle first.
bool meets_cone(const ViewingCone& cone, const std::array<Eigen::Vector3f, 3>& corners_C_mm) noexcept;

}  // namespace orcart
