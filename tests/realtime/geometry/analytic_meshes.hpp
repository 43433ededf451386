// Meshes whose every number is known: for tests of geometry and mapper.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>

#include <Eigen/Core>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart::testing {

/// A sphere about `centre` out of an icosahedron whose triangles are split in four `splits` times: closed,
/// outward.
inline TriangleMesh icosphere(float radius_mm, int splits,
                              const Eigen::Vector3f& centre = Eigen::Vector3f::Zero()) {
  const float g = 1.618033989F;
  TriangleMesh mesh;
  mesh.vertices_mm = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int i = 0; i < splits; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices_mm.size()));
      if (fresh) mesh.vertices_mm.emplace_back((mesh.vertices_mm[a] + mesh.vertices_mm[b]) / 2);
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (auto& v : mesh.vertices_mm) v = centre + radius_mm * v.normalized();
  return mesh;
}

/// A square of `cells` x `cells` cells, two triangles each, at height z_mm; its normal is -z: it faces a
/// camera that looks along +z from below.
inline TriangleMesh plane_grid(float half_side_mm, std::uint32_t cells, float z_mm) {
  TriangleMesh mesh;
  const float step = 2 * half_side_mm / static_cast<float>(cells);
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x)
      mesh.vertices_mm.emplace_back(static_cast<float>(x) * step - half_side_mm,
                                    static_cast<float>(y) * step - half_side_mm, z_mm);
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

/// Both meshes as one; the second's triangles follow the first's.
inline TriangleMesh joined(TriangleMesh first, const TriangleMesh& second) {
  const auto offset = static_cast<std::uint32_t>(first.vertices_mm.size());
  first.vertices_mm.insert(first.vertices_mm.end(), second.vertices_mm.begin(), second.vertices_mm.end());
  for (const auto& [a, b, c] : second.triangles)
    first.triangles.push_back({a + offset, b + offset, c + offset});
  return first;
}

/// Triangles of all shapes and sizes, needles and points among them, with corners in a cube about the origin.
inline TriangleMesh triangle_soup(std::uint32_t count, float half_side_mm, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-half_side_mm, half_side_mm), exponent(-3, 0.3F);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3f at(place(random), place(random), place(random));
    for (std::uint32_t c = 0; c < 3; ++c) {
      const Eigen::Vector3f offset(place(random), place(random), place(random));
      mesh.vertices_mm.emplace_back(
          i % 50 == 0 ? at : Eigen::Vector3f(at + std::pow(10.F, exponent(random)) * offset));
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace orcart::testing
