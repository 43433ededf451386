// The five rays of step 5: through the centre and the four edges of the picture, and what paper mode takes
// from them.
#pragma once

#include <array>

#include "realtime/geometry/ray_scene.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// Unit directions in C, in the order centre, left, right, top, bottom.
using FiveDirections = std::array<Eigen::Vector3d, 5>;

/// Through the lens: the optical axis and the mask circle's four edge points. An edge point that the lens
/// does not see is taken at the cone's half angle.
FiveDirections lens_directions(const ScopeModel& scope);

/// Of the rectified picture that paper mode paints: a square pinhole picture about the optical axis whose
/// edges lie at the cone's half angle, so that s = 0, 1 and t = 1, 0 are its left, right, top and bottom
/// edge.
FiveDirections rectified_directions(const ScopeModel& scope);

/// Traces the five to the surface, no deeper than far_mm along C's z.
FiveRays trace_five_rays(const RayScene& surface, const Pose<M, C>& X_MC, const FiveDirections& directions,
                         double far_mm) noexcept;

/// S1 = h_left + h_right and T1 = h_top + h_bottom, h the distance of an edge ray's hit from the central ray.
/// One edge missed: twice the other. Both: the centre's depth times the width of the cone. Centre missed: not
/// valid.
PaperProjection paper_projection(const Pose<M, C>& X_MC, const FiveRays& rays,
                                 double cone_half_angle_rad) noexcept;

}  // namespace orcart
