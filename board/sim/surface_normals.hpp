// Smooth normals of a surface, so that shading does not show its triangles.
#pragma once

#include <vector>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// One unit normal per vertex, the area-weighted mean of its triangles' outward normals.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh);

}  // namespace orcart
