// Which triangles share an edge: for growing charts.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// neighbours[t][e]: the triangle across edge e (corners e, e+1) of triangle t; 0xFFFFFFFF where there is
/// none or the edge has more than two triangles.
inline std::vector<std::array<std::uint32_t, 3>> triangle_neighbours(const TriangleMesh& mesh) {
  struct Edge {
    std::uint64_t key;
    std::uint32_t triangle, side;
  };
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t e = 0; e < 3; ++e) {
      const std::uint64_t a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, e});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  std::vector<std::array<std::uint32_t, 3>> neighbours(mesh.triangles.size(),
                                                       {0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF});
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].key == edges[i].key) ++end;
    if (end - i == 2) {
      neighbours[edges[i].triangle][edges[i].side] = edges[i + 1].triangle;
      neighbours[edges[i + 1].triangle][edges[i + 1].side] = edges[i].triangle;
    }
    i = end;
  }
  return neighbours;
}

}  // namespace orcart
