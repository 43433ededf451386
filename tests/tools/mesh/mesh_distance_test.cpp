// Distances to a cube, known by hand, and against every triangle.
#include "tools/mesh/mesh_distance.hpp"

#include <gtest/gtest.h>

#include "tests/tools/mesh/shapes.hpp"

namespace orcart {
namespace {

double distance_mm(const Eigen::Vector3f& point, const TriangleMesh& mesh) {
  return distance_to_mesh(std::span(&point, 1), mesh).max_mm;
}

TEST(MeshDistance, ToFaceEdgeAndCornerOfACube) {
  const TriangleMesh mesh = cube(10);
  EXPECT_NEAR(distance_mm({5, 5, 13}, mesh), 3, 1e-5);
  EXPECT_NEAR(distance_mm({5, 13, 14}, mesh), 5, 1e-5);
  EXPECT_NEAR(distance_mm({12, 13, 16}, mesh), 7, 1e-5);
  EXPECT_NEAR(distance_mm({5, 5, 4}, mesh), 4, 1e-5);
  EXPECT_NEAR(distance_mm({500, 5, 5}, mesh), 490, 1e-3);
}

TEST(MeshDistance, TheNearerOfTwoCubesIsFoundThroughManyEmptyCells) {
  const TriangleMesh mesh = both(cube(1), cube(1, {100, 0, 0}));
  EXPECT_NEAR(distance_mm({60, 0.5F, 0.5F}, mesh), 40, 1e-4);
  EXPECT_NEAR(distance_mm({40, 0.5F, 0.5F}, mesh), 39, 1e-4);
}

TEST(MeshDistance, MeanAndPercentileAreOverThePointsAsked) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 100; ++i) points.emplace_back(5, 5, 10 + static_cast<float>(i));
  const auto all = distance_to_mesh(points, cube(10));
  EXPECT_EQ(all.points, 100U);
  EXPECT_NEAR(all.mean_mm, 49.5, 1e-3);
  EXPECT_NEAR(all.p95_mm, 95, 1e-3);
  EXPECT_EQ(distance_to_mesh(points, cube(10), 10).points, 10U);
}

}  // namespace
}  // namespace orcart
