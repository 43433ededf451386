// The pieces of a surface that hang together.
#pragma once

#include <cstddef>
#include <vector>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// For each triangle the piece it belongs to, pieces numbered by their triangle counts, the largest 0.
struct MeshComponents {
  std::vector<std::uint32_t> component_of;
  std::vector<std::size_t> triangles;  ///< of each piece
};
MeshComponents components_of(const TriangleMesh& mesh);

/// The triangles of one piece, with the vertices that they use.
TriangleMesh component(const TriangleMesh& mesh, const MeshComponents& pieces, std::size_t wanted);

}  // namespace orcart
