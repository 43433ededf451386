// The cutout of a view on meshes whose answer is known: cone, facing, occlusion, caps and odd poses.
#include "realtime/mapper/mapper.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/realtime/mapper/mapper_fixture.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using testing::looking;
using testing::surface_of;
using testing::whole_view;
using testing::WholeView;

Mapper mapper_over(const TriangleMesh& mesh, SeenFrom seen_from = SeenFrom::outside,
                   const MapperLimits& limits = {}) {
  return Mapper::create(surface_of(mesh), seen_from, testing::pinhole_scope(), limits).value();
}

Eigen::Vector3d centroid(const TriangleMesh& mesh, std::uint32_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return ((mesh.vertices_mm[a] + mesh.vertices_mm[b] + mesh.vertices_mm[c]) / 3).cast<double>();
}

TEST(Mapper, CutsADiscOutOfAPlane) {
  const TriangleMesh plane = testing::plane_grid(50, 200, 0);
  Mapper mapper = mapper_over(plane);
  const WholeView view = whole_view(mapper, looking({0, 0, -20}, {0, 0, 0}));
  // A disc of radius 20 tan(35 degrees) = 14.0 mm in cells of 0.125 mm2 a triangle, and a rim of whole
  // triangles.
  const double disc = std::numbers::pi * 14.004 * 14.004 / 0.125;
  EXPECT_GT(view.painted.size(), disc);
  EXPECT_LT(view.painted.size(), disc + 2 * std::numbers::pi * 14.004 * 2 / 0.5);
  EXPECT_TRUE(view.occluders.empty());
  for (const std::uint32_t t : view.painted) EXPECT_LT(centroid(plane, t).norm(), 14.004 + 0.5);
}

TEST(Mapper, PaintsTheFarSideOfASphereFromInside) {
  const TriangleMesh sphere = testing::icosphere(30, 5);
  const Pose<M, C> centre = looking({0.1, 0.2, 0.3}, {0, 0, 20});
  Mapper inside = mapper_over(sphere, SeenFrom::inside);
  const WholeView view = whole_view(inside, centre);
  EXPECT_GT(view.painted.size(), 1500U);
  EXPECT_TRUE(view.occluders.empty());
  Mapper outside = mapper_over(sphere, SeenFrom::outside);
  EXPECT_EQ(whole_view(outside, centre).occluders, view.painted);
}

TEST(Mapper, PaintsTheNearSideOfASphereFromOutside) {
  const TriangleMesh sphere = testing::icosphere(10, 5);
  Mapper mapper = mapper_over(sphere);
  const WholeView view = whole_view(mapper, looking({0, 0, -30}, {0, 0, 0}));
  EXPECT_EQ(view.in_cone(), sphere.triangles.size());
  // Seen is the cap beyond which the ray is tangent, less what is steeper than 80 degrees: z < -10 (10/30) -
  // ...
  for (const std::uint32_t t : view.painted) EXPECT_LT(centroid(sphere, t).z(), -10.0 / 3);
  for (const std::uint32_t t : view.occluders) EXPECT_GT(centroid(sphere, t).z(), -5.8);
}

TEST(Mapper, LeavesOutWhatAnotherPlateHides) {
  // A small plate at 10 mm before a large one at 20 mm: its shadow is twice as large.
  const TriangleMesh front = testing::plane_grid(3, 12, 10), back = testing::plane_grid(30, 120, 20);
  const TriangleMesh mesh = testing::joined(front, back);
  Mapper mapper = mapper_over(mesh);
  const WholeView view = whole_view(mapper, looking({0, 0, 0}, {0, 0, 1}));
  const auto is_front = [&](std::uint32_t t) { return t < front.triangles.size(); };
  EXPECT_EQ(std::count_if(view.painted.begin(), view.painted.end(), is_front),
            static_cast<std::ptrdiff_t>(front.triangles.size()));
  for (const std::uint32_t t : view.painted)
    EXPECT_TRUE(is_front(t) || centroid(mesh, t).cwiseAbs().head<2>().maxCoeff() > 6 - 0.51);
  for (const std::uint32_t t : view.occluders)
    EXPECT_LT(centroid(mesh, t).cwiseAbs().head<2>().maxCoeff(), 6);
  EXPECT_GE(view.occluders.size(), 11 * 11 / 0.125);  // of the rim, those with no corner in sight
  EXPECT_LE(view.occluders.size(), 12 * 12 / 0.125);
}

TEST(Mapper, HidesTheFloorOfAFoldBehindItsFlank) {
  // A sheet folded over: from above, the lower leaf lies behind the upper, which faces the scope.
  const TriangleMesh upper = testing::plane_grid(15, 60, 10), lower = testing::plane_grid(15, 60, 12);
  const TriangleMesh mesh = testing::joined(upper, lower);
  Mapper mapper = mapper_over(mesh);
  const WholeView view = whole_view(mapper, looking({0, 0, 0}, {0, 0, 1}));
  for (const std::uint32_t t : view.painted) EXPECT_LT(t, upper.triangles.size());
}

TEST(Mapper, KeepsALargeTriangleWhoseCornersAreSteepButWhoseMiddleIsNot) {
  TriangleMesh mesh;
  mesh.vertices_mm = {{-40, -40, 1}, {0, 50, 1}, {40, -40, 1}};
  mesh.triangles = {{0, 1, 2}};
  Mapper mapper = mapper_over(mesh);
  EXPECT_EQ(whole_view(mapper, looking({0, 0, 0}, {0, 0, 1})).painted.size(), 1U);
}

TEST(Mapper, GivesNoPaintToASteepPlane) {
  const TriangleMesh plane = testing::plane_grid(50, 100, 0);
  Mapper mapper = mapper_over(plane);
  // 1 mm above the plane, looking along it: the ray to a point d mm ahead is atan(d) off the normal; 80
  // degrees at 5.67.
  const WholeView view = whole_view(mapper, looking({0, 0, -1}, {10, 0, -1}, {0, 0, -1}));
  EXPECT_GT(view.occluders.size(), 1000U);
  for (const std::uint32_t t : view.painted) EXPECT_LT(centroid(plane, t).norm(), 5.67 + 1.1);
  for (const std::uint32_t t : view.occluders) EXPECT_GT(centroid(plane, t).norm(), 5.67 - 0.1);
}

TEST(Mapper, MeetsTrianglesWithoutArea) {
  TriangleMesh mesh = testing::plane_grid(20, 20, 10);
  mesh.triangles.push_back({0, 0, 0});
  mesh.triangles.push_back({220, 220, 221});
  Mapper mapper = mapper_over(mesh);
  const WholeView view = whole_view(mapper, looking({0, 0, 0}, {0, 0, 1}));
  EXPECT_EQ(view.occluders, std::vector<std::uint32_t>{801});
}

TEST(Mapper, AnswersWithAnEmptyPartWhereItSeesNothing) {
  Mapper mapper = mapper_over(testing::icosphere(10, 2));
  const WholeView view = whole_view(mapper, looking({0, 0, -30}, {0, 0, -60}));
  EXPECT_EQ(view.parts, 1U);
  EXPECT_EQ(view.in_cone(), 0U);
  EXPECT_TRUE(view.last.first_part && view.last.last_part);
}

TEST(Mapper, SeesNothingBeforeTheFirstViewAndAfterTheLastPart) {
  Mapper mapper = mapper_over(testing::icosphere(10, 2));
  CutoutPatch patch(patch_capacity({}));
  EXPECT_FALSE(mapper.next(patch));
  mapper.begin({}, TextureMode::perspective);
  EXPECT_TRUE(mapper.next(patch));
  EXPECT_FALSE(mapper.next(patch));
}

TEST(Mapper, SeesNothingFromAPoseThatIsNotANumber) {
  Mapper mapper = mapper_over(testing::icosphere(10, 3));
  Pose<M, C> X_MC;
  X_MC.rotation(0, 0) = X_MC.translation_mm.z() = NAN;
  EXPECT_EQ(whole_view(mapper, X_MC).in_cone(), 0U);
}

TEST(Mapper, StandsATipInAVertexInAnEdgeAndInATriangle) {
  const TriangleMesh sphere = testing::icosphere(20, 4);
  Mapper mapper = mapper_over(sphere, SeenFrom::inside);
  const Eigen::Vector3d corner = sphere.vertices_mm[200].cast<double>();
  const Eigen::Vector3d other = sphere.vertices_mm[sphere.triangles[17][1]].cast<double>();
  for (const Eigen::Vector3d& tip : {corner, centroid(sphere, 17), Eigen::Vector3d((corner + other) / 2)})
    EXPECT_LE(whole_view(mapper, looking(tip, {1, 0.5, 0.2})).in_cone(), sphere.triangles.size());
}

TEST(Mapper, CarriesWhatExceedsItsCapsAndLosesNothing) {
  const TriangleMesh sphere = testing::icosphere(20, 5);
  const Pose<M, C> X_MC = looking({1, 2, -40}, {0, 0, 0});
  Mapper whole = mapper_over(sphere);
  const WholeView reference = whole_view(whole, X_MC);
  ASSERT_EQ(reference.parts, 1U);
  for (const MapperLimits& limits :
       {MapperLimits{.max_triangles_per_step = 500}, MapperLimits{.max_rays_per_step = 300},
        MapperLimits{.max_triangles_per_step = 1, .max_rays_per_step = 1}}) {
    Mapper capped = mapper_over(sphere, SeenFrom::outside, limits);
    CutoutPatch patch(patch_capacity(limits));
    std::vector<std::uint32_t> painted;
    capped.begin(X_MC, TextureMode::perspective);
    bool last = false;
    for (int parts = 0; capped.next(patch); ++parts) {
      EXPECT_FALSE(last);
      EXPECT_EQ(patch.first_part, parts == 0);
      EXPECT_LE(patch.triangles.size() + patch.occluders.size(), patch_capacity(limits));
      painted.insert(painted.end(), patch.triangles.begin(), patch.triangles.end());
      last = patch.last_part;
    }
    EXPECT_TRUE(last);
    std::sort(painted.begin(), painted.end());
    EXPECT_EQ(painted, reference.painted);
  }
}

TEST(Mapper, HandsOutWhatHidesBeforeWhatIsHidden) {
  const TriangleMesh near = testing::plane_grid(6, 40, 10), far = testing::plane_grid(12, 40, 20);
  const MapperLimits limits{.max_triangles_per_step = 400};
  Mapper mapper = mapper_over(testing::joined(near, far), SeenFrom::outside, limits);
  CutoutPatch patch(patch_capacity(limits));
  mapper.begin(looking({0, 0, 0}, {0, 0, 1}), TextureMode::perspective);
  ASSERT_TRUE(mapper.next(patch));
  EXPECT_FALSE(patch.last_part);
  EXPECT_GT(patch.triangles.size(), 300U);
  for (const std::uint32_t t : patch.triangles) EXPECT_LT(t, near.triangles.size());
  EXPECT_TRUE(patch.occluders.empty());
}

TEST(Mapper, ForgetsACarriedViewWhenANewOneBegins) {
  const MapperLimits limits{.max_triangles_per_step = 100};
  const TriangleMesh sphere = testing::icosphere(20, 4);
  Mapper mapper = mapper_over(sphere, SeenFrom::outside, limits);
  const WholeView reference = whole_view(mapper, looking({0, 0, 40}, {0, 0, 0}), limits);
  CutoutPatch patch(patch_capacity(limits));
  mapper.begin(looking({0, 0, -40}, {0, 0, 0}), TextureMode::perspective);
  ASSERT_TRUE(mapper.next(patch));
  ASSERT_FALSE(patch.last_part);
  EXPECT_EQ(whole_view(mapper, looking({0, 0, 40}, {0, 0, 0}), limits).painted, reference.painted);
}

TEST(Mapper, EndsAViewWhoseSlotIsTooSmallForOneCluster) {
  Mapper mapper = mapper_over(testing::icosphere(20, 4));
  CutoutPatch patch(10);
  mapper.begin(looking({0, 0, -40}, {0, 0, 0}), TextureMode::perspective);
  EXPECT_TRUE(mapper.next(patch));
  EXPECT_TRUE(patch.triangles.empty() && patch.last_part);
  EXPECT_FALSE(mapper.next(patch));
}

TEST(Mapper, AllocatesNothingInAnyMode) {
  Mapper mapper = mapper_over(testing::icosphere(20, 5), SeenFrom::inside, {.max_triangles_per_step = 2000});
  CutoutPatch patch(patch_capacity({.max_triangles_per_step = 2000}));
  for (const TextureMode mode : {TextureMode::perspective, TextureMode::paper}) {
    const auto step = [&] {
      mapper.begin(looking({1, 2, 3}, {10, 0, 0}), mode);
      while (mapper.next(patch)) {
      }
    };
    step();
    EXPECT_TRUE(testing::zero_allocation(step));
  }
}

TEST(Mapper, RefusesWhatItCannotMap) {
  EXPECT_FALSE(Mapper::create(surface_of({}), SeenFrom::outside, testing::pinhole_scope()));
  ScopeModel scope = testing::pinhole_scope();
  scope.cone_half_angle_rad = 0;
  const auto refused = Mapper::create(surface_of(testing::icosphere(10, 1)), SeenFrom::outside, scope);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "the scope's cone half angle is 0.000000 rad; it must be above 0 and at most 1.48 (85 degrees)");
}

}  // namespace
}  // namespace orcart
