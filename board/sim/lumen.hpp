// Asking a closed surface where its inside is and how much room there is: what a path for a scope is planned
// with.
#pragma once

#include "realtime/geometry/ray_scene.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// Whether a point lies inside a closed surface: most of 14 directions leave it through an outward-facing
/// triangle.
bool inside(const TriangleMesh& mesh, const RayScene& rays, const Eigen::Vector3f& point_mm);

/// The distance to the surface along the nearest of 162 directions; no more than reach_mm. Never below the
/// true one.
float clearance_mm(const RayScene& rays, const Eigen::Vector3f& point_mm, float reach_mm = 50);

/// Whether a straight move keeps at least `room_mm` of clearance, looked at every 0.7 mm.
bool free_way(const RayScene& rays, const Eigen::Vector3f& from_mm, const Eigen::Vector3f& to_mm,
              float room_mm);

}  // namespace orcart
