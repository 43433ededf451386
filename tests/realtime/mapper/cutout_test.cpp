// The cutout in its three forms against the mapper, the definition in double precision, and closed forms.
#include "realtime/mapper/cutout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "realtime/mapper/paper_coordinates.hpp"
#include "tests/realtime/mapper/mapper_fixture.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using Triangle = std::array<Eigen::Vector3f, 3>;
constexpr std::size_t kRoom = 100'000;

bool before(const Triangle& a, const Triangle& b) {
  for (std::size_t c = 0; c < 3; ++c)
    for (Eigen::Index i = 0; i < 3; ++i)
      if (a[c][i] != b[c][i]) return a[c][i] < b[c][i];
  return false;
}

/// A surface with its trees; a plate behind everything gives the centre ray its hit.
struct Scene {
  explicit Scene(TriangleMesh m) : mesh(std::move(m)) {}
  TriangleMesh mesh;
  ClusterTree tree = ClusterTree::create(mesh).value();
  RayScene rays = RayScene::create(mesh).value();
  ScopeModel scope = testing::pinhole_scope();

  Cutout cutout(CutoutRule rule = CutoutRule::touching) const { return {tree, rays, scope, rule}; }
  Triangle triangle(std::uint32_t t) const {
    const auto& [a, b, c] = mesh.triangles[t];
    return {mesh.vertices_mm[a], mesh.vertices_mm[b], mesh.vertices_mm[c]};
  }
  std::vector<Triangle> sorted(const std::vector<std::uint32_t>& ids) const {
    std::vector<Triangle> all;
    all.reserve(ids.size());
    for (const std::uint32_t t : ids) all.push_back(triangle(t));
    std::sort(all.begin(), all.end(), before);
    return all;
  }
};

Eigen::Vector3f vertex(const CutoutMesh& mesh, std::uint32_t i) {
  return {mesh.x_mm[i], mesh.y_mm[i], mesh.z_mm[i]};
}

struct View {
  std::vector<Triangle> triangles;
  std::uint32_t with_corner = 0, uncut = 0, parts = 0;
  double area_mm2 = 0;
  bool valid = false;
};

View view_of(Cutout& cutout, const Pose<M, C>& X_MC, CutoutForm form, std::size_t room = kRoom) {
  CutoutMesh mesh(room);
  View view;
  cutout.begin(X_MC, form);
  while (cutout.next(mesh)) {
    ++view.parts;
    view.with_corner += mesh.with_corner;
    view.uncut += mesh.uncut;
    view.valid = mesh.paper.valid;
    for (std::uint32_t i = 0; i < mesh.triangles; ++i) {
      Triangle t;
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_LT(mesh.corners[i][c], mesh.vertices);
        t[c] = vertex(mesh, mesh.corners[i][c]);
      }
      view.area_mm2 += 0.5 * (t[1] - t[0]).cast<double>().cross((t[2] - t[0]).cast<double>()).norm();
      view.triangles.push_back(t);
    }
  }
  std::sort(view.triangles.begin(), view.triangles.end(), before);
  return view;
}

Pose<M, C> random_pose(std::mt19937& random, double spread_mm) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return pose_from_quaternion<M, C>(
      q, spread_mm * Eigen::Vector3d(normal(random), normal(random), normal(random)));
}

/// Depth in the solid cone, mm: the lesser of that under the flank and that before the far plane.
double depth_in_solid(const ScopeModel& scope, const Pose<M, C>& X_MC, const Eigen::Vector3f& p_mm) {
  const Eigen::Vector3d p = (X_MC.inverse() * Point<M>{p_mm.cast<double>()}).mm;
  return std::min(p.z() * std::tan(scope.cone_half_angle_rad) - p.head<2>().norm(), scope.far_mm - p.z());
}

void expect_the_mappers_triangles(const Scene& scene, double spread_mm) {
  Cutout cutout = scene.cutout();
  Mapper mapper = Mapper::create(testing::surface_of(scene.mesh), SeenFrom::outside, scene.scope).value();
  std::mt19937 random(4);
  std::size_t compared = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose<M, C> X_MC = random_pose(random, spread_mm);
    const View view = view_of(cutout, X_MC, CutoutForm::whole);
    if (!view.valid) continue;
    testing::WholeView expected = testing::whole_view(mapper, X_MC);
    expected.painted.insert(expected.painted.end(), expected.occluders.begin(), expected.occluders.end());
    ASSERT_EQ(view.triangles, scene.sorted(expected.painted));
    compared += view.triangles.size();
  }
  EXPECT_GT(compared, 5000U);
}

TEST(Cutout, HoldsTheMappersTrianglesOfASphere) {
  expect_the_mappers_triangles(Scene(testing::icosphere(30, 4)), 15);
}

TEST(Cutout, HoldsTheMappersTrianglesOfAllShapesAndSizes) {
  expect_the_mappers_triangles(Scene(testing::triangle_soup(4000, 60, 9)), 30);
}

TEST(Cutout, ByCornersHoldsThoseWithACornerInTheConeByDoublePrecision) {
  const Scene scene(testing::icosphere(30, 5));
  Cutout cutout = scene.cutout(CutoutRule::corner);
  std::mt19937 random(3);
  for (int i = 0; i < 30; ++i) {
    const Pose<M, C> X_MC = random_pose(random, 12);
    const View view = view_of(cutout, X_MC, CutoutForm::whole);
    if (!view.valid) continue;
    std::size_t sure = 0, unclear = 0;
    for (const auto& [a, b, c] : scene.mesh.triangles) {
      double deepest = -1e9;
      for (const std::uint32_t v : {a, b, c})
        deepest = std::max(deepest, depth_in_solid(scene.scope, X_MC, scene.mesh.vertices_mm[v]));
      sure += deepest > 1e-4 ? 1 : 0;
      unclear += std::abs(deepest) <= 1e-4 ? 1 : 0;
    }
    EXPECT_GE(view.triangles.size(), sure);
    EXPECT_LE(view.triangles.size(), sure + unclear);
    EXPECT_EQ(view.with_corner, view.triangles.size());
  }
}

TEST(Cutout, GivesThePapersTextureCoordinates) {
  const Scene scene(testing::icosphere(30, 4));
  Cutout cutout = scene.cutout();
  CutoutMesh mesh(kRoom);
  for (const CutoutForm form : {CutoutForm::whole, CutoutForm::clip}) {
    cutout.begin(testing::looking({1, 2, -45}, {3, 0, 0}), form);
    ASSERT_TRUE(cutout.next(mesh));
    ASSERT_GT(mesh.triangles, 50U);
    for (std::uint32_t i = 0; i < mesh.triangles; ++i)
      for (const std::uint32_t v : mesh.corners[i]) {
        const Eigen::Vector2f expected = paper_coordinates(mesh.paper, vertex(mesh, v));
        EXPECT_NEAR(mesh.s[v], expected.x(), 2e-6);
        EXPECT_NEAR(mesh.t[v], expected.y(), 2e-6);
      }
  }
}

TEST(Cutout, ClippedIsADiscOutOfAPlane) {
  const Scene scene(testing::plane_grid(40, 160, 30));
  Cutout cutout = scene.cutout();
  const View view = view_of(cutout, testing::looking({0.3, 0.1, 0}, {0.3, 0.1, 1}), CutoutForm::clip);
  const double radius = 30 * std::tan(scene.scope.cone_half_angle_rad);
  EXPECT_NEAR(view.area_mm2, std::numbers::pi * radius * radius, 1e-3 * radius * radius);
  EXPECT_EQ(view.uncut, 0U);
}

TEST(Cutout, ClippedIsAnEllipseOutOfASlantedPlaneAndEndsAtTheFarPlane) {
  // The plane z = 30 seen at 20 degrees: semi-axes a = d cos(s) sin(h) cos(h) / (cos^2 s - sin^2 h) and
  // b = d cos(s) sin(h) / sqrt(cos^2 s - sin^2 h), with d the distance along the axis.
  Scene scene(testing::plane_grid(80, 320, 30));
  const double slant = 20 * std::numbers::pi / 180, half = scene.scope.cone_half_angle_rad;
  const Pose<M, C> X_MC = testing::looking({0, 0, 0}, {std::sin(slant), 0, std::cos(slant)});
  const double height = 30, apart = std::cos(slant) * std::cos(slant) - std::sin(half) * std::sin(half);
  const double a = height * std::sin(half) * std::cos(half) / apart,
               b = height * std::sin(half) / std::sqrt(apart);
  Cutout cutout = scene.cutout();
  EXPECT_NEAR(view_of(cutout, X_MC, CutoutForm::clip).area_mm2, std::numbers::pi * a * b, 1e-3 * a * b);
  scene.scope.far_mm = 35;
  Cutout nearer = scene.cutout();
  const View cut = view_of(nearer, X_MC, CutoutForm::clip);
  EXPECT_LT(cut.area_mm2, 0.9 * std::numbers::pi * a * b);
  for (const Triangle& t : cut.triangles)
    for (const Eigen::Vector3f& p : t) EXPECT_GT(depth_in_solid(scene.scope, X_MC, p), -1e-4);
}

TEST(Cutout, ClippedStaysInTheConeAndKeepsAllThatIsInside) {
  const Scene scene(testing::icosphere(30, 4));
  Cutout cutout = scene.cutout();
  std::mt19937 random(5);
  std::size_t cut = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose<M, C> X_MC = random_pose(random, 20);
    const View whole = view_of(cutout, X_MC, CutoutForm::whole);
    const View clipped = view_of(cutout, X_MC, CutoutForm::clip);
    EXPECT_LE(clipped.area_mm2, whole.area_mm2 * (1 + 1e-6));
    if (clipped.uncut > 0) continue;
    for (const Triangle& t : clipped.triangles)
      for (const Eigen::Vector3f& p : t) ASSERT_GT(depth_in_solid(scene.scope, X_MC, p), -2e-4);
    for (const Triangle& t : whole.triangles) {
      double least = 1e9;
      for (const Eigen::Vector3f& p : t) least = std::min(least, depth_in_solid(scene.scope, X_MC, p));
      const bool kept = std::binary_search(clipped.triangles.begin(), clipped.triangles.end(), t, before);
      ASSERT_TRUE(kept || least <= 1e-3);
      cut += least < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(cut, 500U);
}

TEST(Cutout, ByCornersClippedEndsOnTheConesSurface) {
  const Scene scene(testing::triangle_soup(4000, 60, 9));
  Cutout cutout = scene.cutout(CutoutRule::corner);
  std::mt19937 random(8);
  std::size_t new_points = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose<M, C> X_MC = random_pose(random, 30);
    const View clipped = view_of(cutout, X_MC, CutoutForm::clip);
    if (!clipped.valid) continue;
    std::size_t expected = 0;
    double area_mm2 = 0;  // each edge's exit by halving, in double precision
    for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      const Triangle corners = scene.triangle(t);
      std::vector<Eigen::Vector3d> polygon;
      std::size_t inside = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Eigen::Vector3d from = corners[c].cast<double>(), to = corners[(c + 1) % 3].cast<double>();
        const auto in = [&](const Eigen::Vector3d& p) {
          return depth_in_solid(scene.scope, X_MC, p.cast<float>()) >= 0;
        };
        if (in(from)) polygon.push_back(from);
        inside += in(from) ? 1 : 0;
        if (in(from) == in(to)) continue;
        double low = 0, high = 1;  // from is where the edge begins; the inner end is at `low`
        for (int halved = 0; halved < 40; ++halved) {
          const double middle = (low + high) / 2, t_in = in(from) ? middle : 1 - middle;
          (in(from + t_in * (to - from)) ? low : high) = middle;
        }
        polygon.push_back(from + (in(from) ? low : 1 - low) * (to - from));
      }
      expected += inside == 0 ? 0 : inside == 2 ? 2 : 1;
      for (std::size_t k = 2; k < polygon.size(); ++k)
        area_mm2 += 0.5 * (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]).norm();
      new_points += inside == 1 || inside == 2 ? 2 : 0;
    }
    ASSERT_NEAR(static_cast<double>(clipped.triangles.size()), static_cast<double>(expected), 1) << i;
    ASSERT_NEAR(clipped.area_mm2, area_mm2, 1e-4 * area_mm2) << i;
    for (const Triangle& t : clipped.triangles)
      for (const Eigen::Vector3f& p : t) ASSERT_GT(depth_in_solid(scene.scope, X_MC, p), -2e-4);
  }
  EXPECT_GT(new_points, 1000U);
}

TEST(Cutout, LeavesATriangleWholeThatOnlyTheAxisPierces) {
  const Scene scene(
      {.vertices_mm = {{-200, -200, 20}, {0, 300, 20}, {200, -200, 20}}, .triangles = {{0, 1, 2}}});
  Cutout cutout = scene.cutout(), by_corner = scene.cutout(CutoutRule::corner);
  const Pose<M, C> X_MC = testing::looking({0, 0, 0}, {0, 0, 1});
  const View clipped = view_of(cutout, X_MC, CutoutForm::clip);
  EXPECT_EQ(clipped.triangles.size(), 1U);
  EXPECT_EQ(clipped.uncut, 1U);
  EXPECT_TRUE(view_of(by_corner, X_MC, CutoutForm::whole).triangles.empty());
}

TEST(Cutout, CarriesWhatExceedsItsRoomAndLosesNothing) {
  const Scene scene(testing::icosphere(20, 5));
  Cutout cutout = scene.cutout();
  const Pose<M, C> everything = testing::looking({0, 0, -36}, {0, 0, 0});
  for (const CutoutForm form : {CutoutForm::whole, CutoutForm::clip}) {
    const View whole = view_of(cutout, everything, form), parts = view_of(cutout, everything, form, 500);
    EXPECT_EQ(whole.parts, 1U);
    EXPECT_EQ(whole.triangles.size(), 20480U);
    EXPECT_GT(parts.parts, 20480U / 500);
    EXPECT_EQ(parts.triangles, whole.triangles);
  }
}

/// On a tree of one cluster, of one level, and of several.
class CutoutRangesOfAll : public ::testing::TestWithParam<int> {};

TEST_P(CutoutRangesOfAll, HoldEveryTriangleOfTheConeOnce) {
  const Scene scene(testing::icosphere(30, GetParam()));
  Cutout cutout = scene.cutout();
  CutoutRanges ranges(scene.tree.cluster_count());
  std::mt19937 random(6);
  for (int i = 0; i < 60; ++i) {
    const Pose<M, C> X_MC = random_pose(random, 15);
    cutout.ranges(X_MC, ranges);
    std::vector<std::uint32_t> ids;
    std::uint32_t end = 0, total = 0;
    for (std::uint32_t r = 0; r < ranges.count; ++r) {
      EXPECT_TRUE(ranges.ranges[r].first > end || r == 0);  // joined where they touch
      end = ranges.ranges[r].first + ranges.ranges[r].count;
      total += ranges.ranges[r].count;
      for (std::uint32_t t = ranges.ranges[r].first; t < end; ++t)
        ids.push_back(scene.tree.triangle_ids()[t]);
    }
    EXPECT_EQ(total, ranges.triangles);
    const View view = view_of(cutout, X_MC, CutoutForm::whole);
    const std::vector<Triangle> all = scene.sorted(ids);
    EXPECT_TRUE(std::includes(all.begin(), all.end(), view.triangles.begin(), view.triangles.end(), before));
  }
}
INSTANTIATE_TEST_SUITE_P(Levels, CutoutRangesOfAll, ::testing::Values(0, 2, 3, 5));

TEST(Cutout, StandsATipInAVertexInAnEdgeAndInATriangle) {
  const Scene scene(testing::icosphere(25, 3));
  Cutout cutout = scene.cutout();
  const Triangle t = scene.triangle(7);
  for (const Eigen::Vector3f& tip :
       {t[0], Eigen::Vector3f((t[0] + t[1]) / 2), Eigen::Vector3f((t[0] + t[1] + t[2]) / 3)})
    for (const CutoutForm form : {CutoutForm::whole, CutoutForm::clip}) {
      const View view = view_of(cutout, testing::looking(tip.cast<double>(), {0, 0, 0}), form);
      EXPECT_EQ(view.parts, 1U);
      for (const Triangle& each : view.triangles)
        for (const Eigen::Vector3f& p : each) EXPECT_TRUE(p.allFinite());
    }
}

TEST(Cutout, StandsAConeThatTouchesAPlaneAlongALine) {
  // The flank lies in the plane z = 0: the axis rises at the half angle above it.
  const Scene scene(testing::joined(testing::plane_grid(50, 100, 0), testing::plane_grid(50, 1, 50)));
  const double half = scene.scope.cone_half_angle_rad;
  Cutout cutout = scene.cutout();
  for (const CutoutForm form : {CutoutForm::whole, CutoutForm::clip}) {
    const View view = view_of(
        cutout, testing::looking({0.25, 0.25, 0}, {0.25 + std::cos(half), 0.25, std::sin(half)}), form);
    EXPECT_LE(view.triangles.size(), 1000U);
    EXPECT_TRUE(std::isfinite(view.area_mm2));
  }
}

TEST(Cutout, StandsTrianglesWithoutArea) {
  TriangleMesh mesh = testing::plane_grid(20, 20, 30);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  for (std::uint32_t i = 0; i < 100; ++i) mesh.triangles.push_back({i, i, i + 1});
  const Scene scene(mesh);
  Cutout cutout = scene.cutout();
  const Pose<M, C> X_MC = testing::looking({0, 0, -10}, {0, 0, 1});
  EXPECT_EQ(view_of(cutout, X_MC, CutoutForm::whole).triangles.size(), count + 100);
  const View clipped = view_of(cutout, testing::looking({0.3, 0.1, 10}, {0.3, 0.1, 11}), CutoutForm::clip);
  const double radius = 20 * std::tan(scene.scope.cone_half_angle_rad);
  EXPECT_NEAR(clipped.area_mm2, std::numbers::pi * radius * radius, 0.02 * radius * radius);
}

TEST(Cutout, SeesNothingFromAPoseThatIsNotANumberAndWhereTheCentreMisses) {
  const Scene scene(testing::icosphere(25, 3));
  Cutout cutout = scene.cutout();
  CutoutRanges ranges(scene.tree.cluster_count());
  Pose<M, C> broken;
  broken.translation_mm.x() = NAN;
  for (const Pose<M, C>& X_MC : {broken, testing::looking({0, 0, -60}, {0, 0, -100})}) {
    const View view = view_of(cutout, X_MC, CutoutForm::whole);
    EXPECT_EQ(view.parts, 1U);
    EXPECT_FALSE(view.valid);
    EXPECT_TRUE(view.triangles.empty());
    cutout.ranges(X_MC, ranges);
    EXPECT_EQ(ranges.count, 0U);
  }
}

TEST(Cutout, AllocatesNothing) {
  const Scene scene(testing::icosphere(20, 5));
  Cutout cutout = scene.cutout();
  CutoutMesh mesh(2000);
  CutoutRanges ranges(scene.tree.cluster_count());
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (const CutoutForm form : {CutoutForm::whole, CutoutForm::clip}) {
      cutout.begin(testing::looking({0, 0, -45}, {0, 0, 0}), form);
      while (cutout.next(mesh)) {
      }
    }
    cutout.ranges(testing::looking({0, 0, -45}, {0, 0, 0}), ranges);
  }));
}

}  // namespace
}  // namespace orcart
