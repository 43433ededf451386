// A cube for the tests of surfaces: 12 triangles, counter-clockwise from outside.
#pragma once

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

inline TriangleMesh cube(float edge_mm, const Eigen::Vector3f& corner_mm = Eigen::Vector3f::Zero()) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.vertices_mm.push_back(corner_mm + edge_mm * Eigen::Vector3f(static_cast<float>(i & 1U),
                                                                     static_cast<float>(i >> 1U & 1U),
                                                                     static_cast<float>(i >> 2U)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Two surfaces in one.
inline TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices_mm.size());
  a.vertices_mm.insert(a.vertices_mm.end(), b.vertices_mm.begin(), b.vertices_mm.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

}  // namespace orcart
