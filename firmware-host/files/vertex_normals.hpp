// Which way a surface faces at each vertex: what viewers shade by.
#pragma once

#include <vector>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// Unit, outward where the triangles are counter-clockwise from outside: the triangles' normals, each by its
/// angle at the vertex (Thuermer and Wuethrich 1998), so that they do not depend on how a flat part is cut
/// into triangles. (0, 0, 1) at a vertex without area.
std::vector<Eigen::Vector3f> angle_weighted_normals(const TriangleMesh& mesh);

/// How many corners of triangles have a stated normal on the side that their winding calls outside, and how
/// many on the other. `normals` has one a vertex.
struct NormalVotes {
  std::size_t along = 0, against = 0;
};
NormalVotes vote_on_winding(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& normals);

}  // namespace orcart
