// Five rays and the paper's texture coordinates on planes, where both are known in closed form.
#include "realtime/mapper/five_rays.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "realtime/mapper/paper_coordinates.hpp"
#include "tests/realtime/mapper/mapper_fixture.hpp"

namespace orcart {
namespace {

const double kTan = std::tan(testing::pinhole_scope().cone_half_angle_rad);

FiveRays rays_onto(const TriangleMesh& mesh, const Pose<M, C>& X_MC) {
  const RayScene surface = RayScene::create(mesh).value();
  return trace_five_rays(surface, X_MC, rectified_directions(testing::pinhole_scope()), 60);
}

PaperProjection paper_onto(const TriangleMesh& mesh, const Pose<M, C>& X_MC = {}) {
  return paper_projection(X_MC, rays_onto(mesh, X_MC), testing::pinhole_scope().cone_half_angle_rad);
}

/// A plane 20 mm in front of the camera that is cut off at x = limit.
TriangleMesh cut_plane(float limit_mm) {
  TriangleMesh mesh;
  mesh.vertices_mm = {{-50, -50, 20}, {limit_mm, -50, 20}, {limit_mm, 50, 20}, {-50, 50, 20}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

TEST(FiveRays, GoThroughTheEdgesOfTheMaskCircle) {
  ScopeModel scope = testing::pinhole_scope();
  scope.lens.fy_px = 150;  // rows twice as tall: the circle is 100 px wide and 50 px high on either side
  scope.mask = {.cx_px = 330, .cy_px = 240, .radius_px = 100};
  const FiveDirections d = lens_directions(scope);
  EXPECT_TRUE(d[0].isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(d[1].isApprox(Eigen::Vector3d(-90.0 / 300, 0, 1).normalized(), 1e-9));
  EXPECT_TRUE(d[2].isApprox(Eigen::Vector3d(110.0 / 300, 0, 1).normalized(), 1e-9));
  EXPECT_TRUE(d[3].isApprox(Eigen::Vector3d(10.0 / 300, -50.0 / 150, 1).normalized(), 1e-9));
  EXPECT_TRUE(d[4].isApprox(Eigen::Vector3d(10.0 / 300, 50.0 / 150, 1).normalized(), 1e-9));
}

TEST(FiveRays, FallBackToTheConeWhereTheLensSeesNoEdge) {
  ScopeModel scope = testing::pinhole_scope();
  scope.lens.max_angle_rad = 0.5;
  EXPECT_TRUE(lens_directions(scope)[2].isApprox(rectified_directions(scope)[2]));
}

TEST(FiveRays, HitAPlaneWhereTheyShould) {
  const FiveRays rays = rays_onto(testing::plane_grid(50, 10, 20), {});
  EXPECT_NEAR(rays.distance_mm[0], 20, 1e-4);
  EXPECT_TRUE(rays.hit_mm[1].isApprox(Eigen::Vector3f(static_cast<float>(-20 * kTan), 0, 20), 1e-5F));
  EXPECT_TRUE(rays.hit_mm[4].isApprox(Eigen::Vector3f(0, static_cast<float>(20 * kTan), 20), 1e-5F));
}

TEST(FiveRays, MissBeyondTheFarPlane) {
  EXPECT_GT(rays_onto(testing::plane_grid(90, 10, 59.9F), {}).distance_mm[1], 59.9F);
  EXPECT_LT(rays_onto(testing::plane_grid(90, 10, 60.1F), {}).distance_mm[0], 0);
}

TEST(PaperProjection, SpansTheConeOnAPlane) {
  const PaperProjection paper = paper_onto(testing::plane_grid(50, 10, 20));
  ASSERT_TRUE(paper.valid);
  EXPECT_NEAR(paper.s_size_mm, 2 * 20 * kTan, 1e-3);
  EXPECT_NEAR(paper.t_size_mm, 2 * 20 * kTan, 1e-3);
  EXPECT_TRUE(paper.up.isApprox(Eigen::Vector3f(0, -1, 0)));
  EXPECT_TRUE(paper.side.isApprox(Eigen::Vector3f(1, 0, 0)));
}

TEST(PaperProjection, TakesTwiceTheOtherWhereOneEdgeMisses) {
  const FiveRays rays = rays_onto(cut_plane(5), {});
  ASSERT_LT(rays.distance_mm[2], 0);
  EXPECT_NEAR(paper_onto(cut_plane(5)).s_size_mm, 2 * 20 * kTan, 1e-3);
}

TEST(PaperProjection, TakesTheConeAtTheCentresDepthWhereBothEdgesMiss) {
  const PaperProjection paper = paper_onto(testing::plane_grid(1, 2, 20));
  ASSERT_TRUE(paper.valid);
  EXPECT_NEAR(paper.s_size_mm, 2 * 20 * kTan, 1e-3);
}

TEST(PaperProjection, RefusesAViewWhoseCentreMisses) {
  EXPECT_FALSE(paper_onto(cut_plane(-5)).valid);
}

TEST(PaperProjection, LeavesAViewWithoutACentreEmpty) {
  Mapper mapper =
      Mapper::create(testing::surface_of(cut_plane(-5)), SeenFrom::outside, testing::pinhole_scope()).value();
  const testing::WholeView view = testing::whole_view(mapper, {}, {}, TextureMode::paper);
  EXPECT_EQ(view.parts, 1U);
  EXPECT_FALSE(view.last.paper.valid);
  EXPECT_EQ(view.in_cone(), 0U);
}

TEST(PaperProjection, TestsNeitherFacingNorOcclusion) {
  const TriangleMesh sphere = testing::icosphere(10, 3);
  Mapper mapper =
      Mapper::create(testing::surface_of(sphere), SeenFrom::outside, testing::pinhole_scope()).value();
  const auto view =
      testing::whole_view(mapper, testing::looking({0, 0, -30}, {0, 0, 0}), {}, TextureMode::paper);
  EXPECT_EQ(view.painted.size(), sphere.triangles.size());
}

TEST(PaperCoordinates, AreThePinholesOnAPlaneSquareToTheView) {
  const Pose<M, C> X_MC = testing::looking({3, -4, -15}, {3, -4, 0}, {0.3, 1, 0});
  const PaperProjection paper = paper_onto(testing::plane_grid(50, 10, 5), X_MC);
  ASSERT_TRUE(paper.valid);
  for (double s = 0; s <= 1; s += 0.1)
    for (double t = 0; t <= 1; t += 0.1) {
      const Point<C> p{20 * Eigen::Vector3d((2 * s - 1) * kTan, (1 - 2 * t) * kTan, 1)};
      const Eigen::Vector2f st = paper_coordinates(paper, (X_MC * p).mm.cast<float>());
      EXPECT_NEAR(st.x(), s, 2e-6);
      EXPECT_NEAR(st.y(), t, 2e-6);
    }
}

TEST(PaperCoordinates, AreOffByTheKnownErrorAtAnotherDepth) {
  const PaperProjection paper = paper_onto(testing::plane_grid(50, 10, 20));
  for (const double z : {12.0, 18.0, 25.0, 40.0}) {
    const double a = 4;
    const double exact = 0.5 + a / (2 * z * kTan);  // where a pinhole sees it
    const Eigen::Vector2f st = paper_coordinates(paper, {static_cast<float>(a), 0, static_cast<float>(z)});
    EXPECT_NEAR(st.x() - exact, a / paper.s_size_mm * (1 - 20 / z), 1e-5) << "depth " << z;
  }
}

TEST(PaperCoordinates, KeepTheSignOfEitherSide) {
  const PaperProjection paper = paper_onto(testing::plane_grid(50, 10, 20));
  EXPECT_LT(paper_coordinates(paper, {-5, 0, 20}).x(), 0.5F);
  EXPECT_GT(paper_coordinates(paper, {5, 0, 20}).x(), 0.5F);
  EXPECT_GT(paper_coordinates(paper, {0, -5, 20}).y(), 0.5F);  // up is -y of the camera
}

}  // namespace
}  // namespace orcart
