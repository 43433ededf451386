// What a surface must be told about: triangles without area, open edges, which way it faces, and its hash.
#pragma once

#include <cstddef>
#include <string>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart::checks {

/// Triangles with three corners in a line, which would leave a slit if they were dropped, share out the
/// neighbour at their longest side; says how many found one.
std::size_t flip_slivers(TriangleMesh& mesh);
/// Removes triangles with a repeated vertex or no area; says how many.
std::size_t drop_degenerate_triangles(TriangleMesh& mesh);
/// Every edge belongs to exactly two triangles, which run along it in opposite directions. A triangle with a
/// repeated vertex has no edges.
bool is_closed(const TriangleMesh& mesh);
/// How many edges do not: 0 where it is closed.
std::size_t unpaired_edges(const TriangleMesh& mesh);
/// Positive for a closed mesh whose triangles are counter-clockwise seen from outside (divergence theorem).
double signed_volume_mm3(const TriangleMesh& mesh);
/// 128 bits in hex over vertices and triangles, in order.
std::string mesh_hash(const TriangleMesh& mesh);

}  // namespace orcart::checks
