// Closed surfaces for tests: a ball, stretched and dented as asked, with outward normals.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart::testing {

/// An ellipsoid about the origin, cut into rings and sectors; `move` may shift each vertex.
inline TriangleMesh ellipsoid(
    const Eigen::Vector3f& radii_mm, std::uint32_t rings, std::uint32_t sectors,
    const std::function<Eigen::Vector3f(const Eigen::Vector3f&)>& move = [](const auto& p) { return p; }) {
  TriangleMesh mesh;
  const auto vertex = [&](float polar, float around) {
    const Eigen::Vector3f unit(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                               std::cos(polar));
    mesh.vertices_mm.push_back(move(unit.cwiseProduct(radii_mm)));
  };
  constexpr float pi = std::numbers::pi_v<float>;
  vertex(0, 0);
  for (std::uint32_t r = 1; r < rings; ++r)
    for (std::uint32_t s = 0; s < sectors; ++s)
      vertex(pi * static_cast<float>(r) / static_cast<float>(rings),
             2 * pi * static_cast<float>(s) / static_cast<float>(sectors));
  vertex(pi, 0);
  const auto last = static_cast<std::uint32_t>(mesh.vertices_mm.size() - 1);
  const auto at = [&](std::uint32_t ring, std::uint32_t s) { return 1 + (ring - 1) * sectors + s % sectors; };
  for (std::uint32_t s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    for (std::uint32_t r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r, s + 1)});
      mesh.triangles.push_back({at(r, s + 1), at(r + 1, s), at(r + 1, s + 1)});
    }
    mesh.triangles.push_back({last, at(rings - 1, s + 1), at(rings - 1, s)});
  }
  return mesh;
}

}  // namespace orcart::testing
