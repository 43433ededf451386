// Where a picture of the surface is taken from, and the matrices that follow from it.
#pragma once

#include <Eigen/Core>
#include <glm/glm.hpp>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// Where the eye is, in M. The field of view is vertical; in a view that is hardly wider than high it is
/// wider, so that what it saw beside stays in it.
struct Eye {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double field_of_view_rad = 0.6;
  /// To the right of `position_mm`, for one eye of a stereo pair. The picture plane stays through the target,
  /// upright: what lies there has no parallax, and nowhere is there a vertical one.
  double sideways_mm = 0;

  bool operator==(const Eye&) const = default;
};

/// An eye that sees the whole surface from a direction (from the surface's centre to the eye; any length).
Eye eye_on(const TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& up);

struct EyePair {
  Eye left, right;
};
/// Two eyes `base_of_distance` times the target's distance apart; a thirtieth is photography's rule of thumb.
EyePair stereo_eyes(const Eye& middle, double base_of_distance = 1.0 / 30);

/// Matrices for framebuffers whose row 0 is the picture's top.
struct EyeMatrices {
  glm::mat4 view{1}, projection{1};
};
EyeMatrices matrices_of(const Eye& eye, double aspect);

}  // namespace orcart
