// Rays against two parallel squares, 10 mm and 20 mm in front of the origin.
#include "realtime/geometry/ray_scene.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace orcart {
namespace {

/// Squares of 10 mm half side at z = 10 (triangles 0, 1) and z = 20 (triangles 2, 3).
TriangleMesh two_squares() {
  TriangleMesh mesh;
  for (const float z : {10.F, 20.F}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_mm.size());
    for (const auto& [x, y] : {std::array{-10.F, -10.F}, {10.F, -10.F}, {10.F, 10.F}, {-10.F, 10.F}})
      mesh.vertices_mm.emplace_back(x, y, z);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

class RaySceneTest : public testing::Test {
 protected:
  TriangleMesh mesh_ = two_squares();
  RayScene rays_ = RayScene::create(mesh_).value();
};

TEST_F(RaySceneTest, FindsTheNearestOfTwo) {
  const auto hit = rays_.nearest({4, -6, 0}, Eigen::Vector3f::UnitZ(), 100);
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->distance_mm, 10);
  EXPECT_EQ(hit->triangle, 0U);
}

TEST_F(RaySceneTest, WeightsTheCorners) {
  const auto hit = rays_.nearest({4, -6, 0}, Eigen::Vector3f::UnitZ(), 100);
  ASSERT_TRUE(hit);
  const auto& t = mesh_.triangles[hit->triangle];
  const Eigen::Vector3f at = (1 - hit->b1 - hit->b2) * mesh_.vertices_mm[t[0]] +
                             hit->b1 * mesh_.vertices_mm[t[1]] + hit->b2 * mesh_.vertices_mm[t[2]];
  EXPECT_TRUE(at.isApprox(Eigen::Vector3f(4, -6, 10), 1e-5F));
}

TEST_F(RaySceneTest, KeepsToNearAndFar) {
  EXPECT_FALSE(rays_.nearest({0, 1, 0}, Eigen::Vector3f::UnitZ(), 9));
  const auto second = rays_.nearest({0, 1, 0}, Eigen::Vector3f::UnitZ(), 100, 15);
  ASSERT_TRUE(second);
  EXPECT_FLOAT_EQ(second->distance_mm, 20);
}

TEST_F(RaySceneTest, LetsNoRayThroughASharedEdge) {
  for (int i = -9; i <= 9; ++i) {
    const auto at = static_cast<float>(i);
    EXPECT_TRUE(rays_.nearest({at, at, 0}, Eigen::Vector3f::UnitZ(), 100)) << i;
  }
}

TEST_F(RaySceneTest, SaysWhatIsHidden) {
  EXPECT_TRUE(rays_.hidden({0, 1, 0}, {0, 2, 20}, 0.05F));
  EXPECT_FALSE(rays_.hidden({0, 1, 0}, {0, 2, 10}, 0.05F));
  EXPECT_FALSE(rays_.hidden({0, 1, 0}, {0, 1, 0}, 0.05F));
}

TEST_F(RaySceneTest, MarksMissedRaysOfMany) {
  const std::array<Eigen::Vector3f, 2> directions{Eigen::Vector3f(0, 0.1F, 1).normalized(), {0, 0, -1}};
  std::array<RayHit, 2> hits;
  rays_.nearest_many({0, 0, 0}, directions, 100, hits);
  EXPECT_GT(hits[0].distance_mm, 10);
  EXPECT_LT(hits[1].distance_mm, 0);
}

TEST_F(RaySceneTest, MeetsNothingAlongARayThatIsNotANumber) {
  EXPECT_FALSE(rays_.nearest({0, NAN, 0}, Eigen::Vector3f::UnitZ(), 100));
  EXPECT_FALSE(rays_.nearest({0, 0, 0}, {0, 0, INFINITY}, 100));
  EXPECT_FALSE(rays_.nearest({0, 0, 0}, Eigen::Vector3f::UnitZ(), NAN));
  EXPECT_FALSE(rays_.hidden({0, 1, 0}, {0, NAN, 20}, 0.05F));
  EXPECT_FALSE(rays_.hidden({0, 1, 0}, {0, INFINITY, 20}, 0.05F));
}

TEST(RayScene, RefusesAMeshWithoutTriangles) {
  EXPECT_FALSE(RayScene::create({}));
}

TEST(RayScene, RefusesATriangleThatNamesAMissingVertex) {
  TriangleMesh mesh = two_squares();
  mesh.triangles[3][1] = 8;
  const auto rays = RayScene::create(mesh);
  ASSERT_FALSE(rays);
  EXPECT_EQ(rays.error().message, "a triangle names vertex 8, but the surface has only 8");
}

}  // namespace
}  // namespace orcart
