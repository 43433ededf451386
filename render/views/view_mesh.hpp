// The surface as it is drawn for an eye: vertices split where charts meet, and a coarser one for an eye that
// moves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/atlas/atlas_layout.hpp"

namespace orcart {

struct ViewVertex {
  std::array<float, 3> position, normal;
  std::array<float, 2> texel;
};

struct ViewMesh {
  std::vector<ViewVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::vector<std::uint32_t> charts;   ///< of each vertex
};

/// Every triangle, chart by chart: neighbours share vertices that were just looked up. Not real-time.
ViewMesh view_mesh(const TriangleMesh& mesh, const AtlasLayout& layout);

/// At most `most_triangles`, by merging the vertices within cubes of one size (Rossignac and Borrel 1993). A
/// chart keeps its own places in the atlas, so paint stays where it is but for the size of a cube. Not
/// real-time.
ViewMesh coarser(const ViewMesh& fine, std::size_t most_triangles);

}  // namespace orcart
