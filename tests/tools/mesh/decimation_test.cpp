// Thinned-out surfaces stay closed, keep their genus, their volume and their facing.
#include "tools/mesh/decimation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_checks.hpp"

namespace orcart {
namespace {

constexpr double kPi = std::numbers::pi;

/// A torus of radii 30 and 10 mm out of 2 * rings * sides triangles, counter-clockwise from outside.
TriangleMesh torus(std::uint32_t rings, std::uint32_t sides) {
  TriangleMesh mesh;
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double around = 2 * kPi * r / rings, about = 2 * kPi * s / sides,
                   from_axis = 30 + 10 * std::cos(about);
      mesh.vertices_mm.push_back(
          Eigen::Vector3d(from_axis * std::cos(around), from_axis * std::sin(around), 10 * std::sin(about))
              .cast<float>());
      const std::uint32_t next_r = (r + 1) % rings, next_s = (s + 1) % sides;
      const std::uint32_t a = r * sides + s, b = next_r * sides + s, c = next_r * sides + next_s,
                          d = r * sides + next_s;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

/// Of a closed surface, whose edges are three halves of its triangles.
long euler_number(const TriangleMesh& mesh) {
  return static_cast<long>(mesh.vertices_mm.size()) - static_cast<long>(mesh.triangles.size() / 2);
}

TEST(Decimation, ATorusStaysAClosedTorusOfTheSameVolume) {
  const TriangleMesh fine = torus(120, 60);
  const TriangleMesh coarse = decimate(fine, 1500);
  EXPECT_LE(coarse.triangles.size(), 1500U);
  EXPECT_GE(coarse.triangles.size(), 1498U);
  EXPECT_TRUE(checks::is_closed(coarse));
  EXPECT_EQ(euler_number(coarse), 0);
  const double exact_mm3 = 2 * kPi * kPi * 30 * 100;
  EXPECT_NEAR(checks::signed_volume_mm3(coarse), exact_mm3, 0.01 * exact_mm3);
}

TEST(Decimation, VerticesStayNearTheSurface) {
  for (const auto& vertex : decimate(torus(120, 60), 1500).vertices_mm) {
    const double from_axis = std::hypot(vertex.x(), vertex.y());
    EXPECT_NEAR(std::hypot(from_axis - 30, vertex.z()), 10, 0.15);
  }
}

TEST(Decimation, StopsBeforeTheTopologyWouldChange) {
  const TriangleMesh least = decimate(torus(24, 12), 4);
  EXPECT_GE(least.triangles.size(), 14U);  // no torus has fewer (Csaszar 1949)
  EXPECT_TRUE(checks::is_closed(least));
  EXPECT_EQ(euler_number(least), 0);
}

TEST(Decimation, AnOpenSurfaceKeepsItsRim) {
  constexpr std::uint32_t kAcross = 60;
  TriangleMesh plane;
  for (std::uint32_t y = 0; y <= kAcross; ++y)
    for (std::uint32_t x = 0; x <= kAcross; ++x)
      plane.vertices_mm.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0F);
  for (std::uint32_t y = 0; y < kAcross; ++y)
    for (std::uint32_t x = 0; x < kAcross; ++x) {
      const std::uint32_t a = y * (kAcross + 1) + x, b = a + kAcross + 1;
      plane.triangles.push_back({a, a + 1, b + 1});
      plane.triangles.push_back({a, b + 1, b});
    }
  const TriangleMesh coarse = decimate(plane, 1000);
  EXPECT_LE(coarse.triangles.size(), 1000U);
  double area_mm2 = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : coarse.triangles) {
    const Eigen::Vector3f ab = coarse.vertices_mm[t[1]] - coarse.vertices_mm[t[0]],
                          ac = coarse.vertices_mm[t[2]] - coarse.vertices_mm[t[0]];
    area_mm2 += static_cast<double>(ab.cross(ac).z()) / 2;
    for (std::size_t i = 0; i < 3; ++i) ++edges[std::minmax({t[i], t[(i + 1) % 3]})];
  }
  EXPECT_NEAR(area_mm2, 3600, 0.1);
  std::map<std::uint32_t, int> open_at;
  for (const auto& [ends, count] : edges) {
    ASSERT_LE(count, 2);
    if (count == 1) ++open_at[ends.first], ++open_at[ends.second];
  }
  EXPECT_EQ(open_at.size(), 4U * kAcross);
  for (const auto& [vertex, count] : open_at) EXPECT_EQ(count, 2) << "a pinch at vertex " << vertex;
}

TEST(Decimation, ASmallEnoughSurfaceIsLeftAlone) {
  const TriangleMesh mesh = torus(12, 6);
  EXPECT_EQ(decimate(mesh, 144).triangles, mesh.triangles);
}

TEST(Decimation, TheSameSurfaceGivesTheSameTriangles) {
  EXPECT_EQ(checks::mesh_hash(decimate(torus(60, 30), 500)), checks::mesh_hash(decimate(torus(60, 30), 500)));
}

}  // namespace
}  // namespace orcart
