// Texture coordinates as the paper computes them (Dey et al. 2000, equations 2 to 6): the mode for
// comparison.
#pragma once

#include <cmath>

#include "realtime/mapper/cutout_patch.hpp"

namespace orcart {

/// (s, t) of a vertex V of M (mm): theta = angle(PV, PO), h = |PV| sin(theta), phi = V's angle about the
/// central ray from U towards W, a = h sin(phi), b = h cos(phi), s = 0.5 + a/S1, t = 0.5 + b/T1. atan2 in
/// place of the paper's cosine alone, which loses the sign of a. Exact where the surface lies at the depth z0
/// at which S1 was taken; elsewhere a vertex at depth z is off by (a/S1)(1 - z0/z). Needs paper.valid. Any
/// thread.
inline Eigen::Vector2f paper_coordinates(const PaperProjection& paper,
                                         const Eigen::Vector3f& vertex_mm) noexcept {
  const Eigen::Vector3f PV = vertex_mm - paper.tip_mm;
  const float r = PV.norm();
  const float theta =
      std::atan2(PV.cross(paper.view).norm(), PV.dot(paper.view));  // acos is blunt near the axis
  const float phi = std::atan2(PV.dot(paper.side), PV.dot(paper.up));
  const float h = r * std::sin(theta);
  return {0.5F + h * std::sin(phi) / paper.s_size_mm, 0.5F + h * std::cos(phi) / paper.t_size_mm};
}

}  // namespace orcart
