// The mapper against a double-precision look at every triangle, from hundreds of poses, odd ones among them.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/realtime/geometry/cone_reference.hpp"
#include "tests/realtime/mapper/mapper_fixture.hpp"

namespace orcart {
namespace {

constexpr double kUnclear_mm = 2e-3;

struct Expected {
  bool in_cone = false, unclear = false;  ///< unclear: within rounding of the cone's surface
  double height_mm = 0;                   ///< of the apex above the triangle's plane, on the outward side
};

Expected look_at(const TriangleMesh& mesh, std::uint32_t t, const Pose<M, C>& X_MC, const ConeShape& shape) {
  std::array<Eigen::Vector3d, 3> p;
  for (std::size_t c = 0; c < 3; ++c)
    p[c] = (X_MC.inverse() * Point<M>{mesh.vertices_mm[mesh.triangles[t][c]].cast<double>()}).mm;
  const double depth = testing::deepest_in_cone(p, shape, kUnclear_mm / 2);
  const Eigen::Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]);
  return {.in_cone = depth > 0,
          .unclear = std::abs(depth) < kUnclear_mm,
          .height_mm = n.norm() > 0 ? -n.normalized().dot(p[0]) : 0};
}

/// Checks one view: the set of triangles in the cone, and that nothing painted faces away.
void compare(const TriangleMesh& mesh, Mapper& mapper, const Pose<M, C>& X_MC, const ScopeModel& scope,
             std::size_t* in_cone) {
  const testing::WholeView view = testing::whole_view(mapper, X_MC);
  const ConeShape shape{.half_angle_rad = scope.cone_half_angle_rad, .far_mm = scope.far_mm};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Expected expected = look_at(mesh, t, X_MC, shape);
    const bool painted = std::binary_search(view.painted.begin(), view.painted.end(), t);
    const bool occludes = std::binary_search(view.occluders.begin(), view.occluders.end(), t);
    ASSERT_FALSE(painted && occludes);
    ASSERT_TRUE(expected.unclear || expected.in_cone == (painted || occludes)) << "triangle " << t;
    ASSERT_TRUE(!painted || expected.height_mm > -1e-9) << "triangle " << t;
    *in_cone += expected.in_cone ? 1U : 0U;
  }
}

Pose<M, C> random_pose(std::mt19937& random, double spread_mm) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return pose_from_quaternion<M, C>(
      q, spread_mm * Eigen::Vector3d(normal(random), normal(random), normal(random)));
}

TEST(MapperAgainstBruteForce, AgreesOnASphereFromEverywhere) {
  const TriangleMesh mesh = testing::icosphere(30, 4);
  const ScopeModel scope = testing::pinhole_scope();
  Mapper mapper = Mapper::create(testing::surface_of(mesh), SeenFrom::outside, scope).value();
  std::mt19937 random(5);
  std::size_t in_cone = 0;
  for (int i = 0; i < 60; ++i) compare(mesh, mapper, random_pose(random, 30), scope, &in_cone);
  EXPECT_GT(in_cone, 5000U);
}

TEST(MapperAgainstBruteForce, AgreesOnTrianglesOfAllShapesAndSizes) {
  const TriangleMesh mesh = testing::triangle_soup(4000, 60, 9);
  const ScopeModel scope = testing::pinhole_scope();
  Mapper mapper = Mapper::create(testing::surface_of(mesh), SeenFrom::outside, scope).value();
  std::mt19937 random(6);
  std::size_t in_cone = 0;
  for (int i = 0; i < 40; ++i) compare(mesh, mapper, random_pose(random, 30), scope, &in_cone);
  EXPECT_GT(in_cone, 5000U);
}

TEST(MapperAgainstBruteForce, AgreesWithTheTipInTheMeshItself) {
  const TriangleMesh mesh = testing::icosphere(25, 3);
  const ScopeModel scope = testing::pinhole_scope();
  Mapper mapper = Mapper::create(testing::surface_of(mesh), SeenFrom::outside, scope).value();
  std::mt19937 random(8);
  std::size_t in_cone = 0;
  for (std::size_t v = 0; v < 40; ++v) {
    Pose<M, C> X_MC = random_pose(random, 0);
    const auto& [a, b, c] = mesh.triangles[v];
    const Eigen::Vector3f corner = mesh.vertices_mm[a],
                          middle = (corner + mesh.vertices_mm[b] + mesh.vertices_mm[c]) / 3;
    X_MC.translation_mm = (v % 2 == 0 ? corner : middle).cast<double>();
    compare(mesh, mapper, X_MC, scope, &in_cone);
  }
  EXPECT_GT(in_cone, 1000U);
}

}  // namespace
}  // namespace orcart
