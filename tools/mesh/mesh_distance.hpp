// How far one surface lies from another: what thinning out a surface has cost, in millimetres.
#pragma once

#include <cstddef>
#include <span>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

struct MeshDistance {
  double mean_mm = 0, p95_mm = 0, max_mm = 0;
  std::size_t points = 0;  ///< that were measured
};

/// The distance of each point to the nearest point of the surface's triangles, exact, found through a grid of
/// cells. Two threads. At most `most_points` of them, evenly picked from the list.
MeshDistance distance_to_mesh(std::span<const Eigen::Vector3f> points_mm, const TriangleMesh& mesh,
                              std::size_t most_points = 200'000);

}  // namespace orcart
