// Paper mode against perspective: the closed form on a slanted plane, nothing where all is of one depth, more
// where it is not.
#include "firmware-host/offline/mode_difference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/offline/difference_map.hpp"
#include "realtime/mapper/mapper.hpp"
#include "tests/render/support/scenes.hpp"
#include "tools/evaluate/scene.hpp"

namespace orcart {
namespace {

/// One view of a surface in paper mode, and what the modes make of it.
struct Compared {
  AtlasLayout layout;
  CutoutPatch view;
  ModeDifference difference;
};

Compared compared(const Surface& surface, const Pose<M, C>& X_MC, SeenFrom seen_from = SeenFrom::outside,
                  double texel_mm = 0.3) {
  const ScopeModel scope = scenes::scope();
  const MapperLimits limits{.max_triangles_per_step =
                                static_cast<std::uint32_t>(surface.mesh.triangles.size()) + 48};
  Mapper mapper = *Mapper::create(surface, seen_from, scope, limits);
  Compared out{.layout = *build_atlas(surface.mesh, {.texel_mm = texel_mm}),
               .view = CutoutPatch(patch_capacity(limits)),
               .difference = {}};
  mapper.begin(X_MC, TextureMode::paper);
  EXPECT_TRUE(mapper.next(out.view));
  EXPECT_TRUE(out.view.paper.valid && out.view.last_part);
  const RayScene rays = *RayScene::create(surface.mesh);
  out.difference = difference_between_modes(surface.mesh, rays, out.layout, out.view, scope.far_mm);
  const ModeDifference& d = out.difference;
  char line[120];
  std::snprintf(line, sizeof line, "mean %.3f mm, 95%% %.3f, max %.3f, %zu texels, %zu lost", d.mean_mm,
                d.p95_mm, d.max_mm, d.texels, d.lost);
  ::testing::Test::RecordProperty("difference", line);
  if (std::getenv("ORCART_PICTURES") != nullptr)
    std::fprintf(stderr, "%s: %s\n", ::testing::UnitTest::GetInstance()->current_test_info()->name(), line);
  return out;
}

/// z = depth + slope x over a square, in fine cells.
Surface slanted(double depth_mm, double slope) {
  Surface plane = scenes::plane(0, 60, 240);
  for (Eigen::Vector3f& v : plane.mesh.vertices_mm)
    v.z() = static_cast<float>(depth_mm + slope * double(v.x()));
  return plane;
}

/// The nearest of all triangles along a ray, one by one, in double (Moeller and Trumbore 1997).
std::optional<Eigen::Vector3d> first_hit(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& ray) {
  double nearest = 1e9;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>(),
                          ab = mesh.vertices_mm[t[1]].cast<double>() - a,
                          ac = mesh.vertices_mm[t[2]].cast<double>() - a, across = ray.cross(ac);
    const double area = ab.dot(across);
    if (std::abs(area) < 1e-12) continue;
    const Eigen::Vector3d from = origin - a, over = from.cross(ab);
    const double b1 = from.dot(across) / area, b2 = ray.dot(over) / area, far = ac.dot(over) / area;
    if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && far > 1e-6) nearest = std::min(nearest, far);
  }
  if (nearest > 1e8) return std::nullopt;
  return origin + nearest * ray;
}

TEST(ModeDifference, FollowsTheClosedFormOnASlantedPlane) {
  constexpr double kDepth = 20, kSlope = 0.4;
  const Surface plane = slanted(kDepth, kSlope);
  const Compared made = compared(plane, {});
  const double half_width = std::tan(scenes::scope().cone_half_angle_rad);
  // The edge rays meet the plane at z = depth / (1 -+ slope tan); S1 is the sum of their distances from the
  // axis.
  const double z_left = kDepth / (1 + kSlope * half_width), z_right = kDepth / (1 - kSlope * half_width);
  const double s_size = half_width * (z_left + z_right), t_size = 2 * half_width * kDepth;
  EXPECT_NEAR(static_cast<double>(made.view.paper.s_size_mm), s_size, 0.01);
  EXPECT_NEAR(static_cast<double>(made.view.paper.t_size_mm), t_size, 0.01);
  std::size_t checked = 0;
  for (std::size_t i = 0; i < made.layout.owners.size(); ++i) {
    if (made.difference.displacement_mm[i] < 0) continue;
    const Eigen::Vector3d v = scenes::point_of(plane, made.layout, i);
    // s - 1/2 = a / S1 puts the slope 2 tan a / S1 where a / z is true: off by (a / S1)(1 - z0 / z) in s, z0
    // = S1 / (2 tan).
    const double z0 = s_size / (2 * half_width), s_error = v.x() / s_size * (1 - z0 / v.z());
    const double x = v.x() / v.z() + 2 * half_width * s_error, y = 2 * half_width * v.y() / t_size;
    const double z = kDepth / (1 - kSlope * x);
    const double expected_mm = (Eigen::Vector3d(x * z, y * z, z) - v).norm();
    ASSERT_NEAR(static_cast<double>(made.difference.displacement_mm[i]), expected_mm, 0.02) << v.transpose();
    ++checked;
  }
  EXPECT_GT(checked, 5'000U);
  EXPECT_GT(made.difference.mean_mm, 1);
}

TEST(ModeDifference, IsNothingOnAPlaneSquareToTheView) {
  const Compared made = compared(scenes::plane(20, 60, 60), {});
  EXPECT_GT(made.difference.texels, 5'000U);
  EXPECT_LT(made.difference.max_mm, 0.02);
}

TEST(ModeDifference, GrowsWithTheDepthOfASphere) {
  // A sphere of 15 mm, its nearest point at 20 mm: at the rim of what is seen the depth is off by several
  // millimetres.
  const Compared made = compared(scenes::sphere({0, 0, 35}, 15, 48), {});
  EXPECT_GT(made.difference.texels, 2'000U);
  EXPECT_GT(made.difference.mean_mm, 0.3);
  EXPECT_LT(made.difference.mean_mm, 10);
}

TEST(ModeDifference, OfAVentricleIsMillimetresAndAgreesWithBruteForce) {
  const auto file = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/surfaces/ventricle.ply";
  const Surface ventricle = read_surface(file).value();
  const RayScene rays = *RayScene::create(ventricle.mesh);
  const ScopeModel scope = scenes::scope();
  const EvaluationScene scene{.mesh = ventricle.mesh, .rays = rays, .scope = scope};
  const double half_width = std::tan(scope.cone_half_angle_rad);
  std::size_t texels = 0, checked = 0, beside = 0;
  double sum_mm = 0;
  for (std::uint64_t number = 0; number < 12; ++number) {
    RandomStream random(1, number);
    const auto view = view_of_chance(scene, random);
    ASSERT_TRUE(view);
    const Compared made = compared(ventricle, *view, SeenFrom::inside, 0.4);
    sum_mm += made.difference.mean_mm * static_cast<double>(made.difference.texels);
    texels += made.difference.texels;
    for (std::size_t i = number; i < made.layout.owners.size(); i += 31) {
      if (made.difference.displacement_mm[i] < 0) continue;
      const Eigen::Vector3d p = scenes::point_of(ventricle, made.layout, i);
      const Eigen::Vector3d p_C = view->rotation.transpose() * (p - view->translation_mm);
      // a = h sin(phi) is x, b = h cos(phi) is -y of C: (s, t) are linear, so interpolating changes nothing.
      const Eigen::Vector3d ray(2 * half_width * p_C.x() / static_cast<double>(made.view.paper.s_size_mm),
                                2 * half_width * p_C.y() / static_cast<double>(made.view.paper.t_size_mm), 1);
      const auto shown = first_hit(ventricle.mesh, view->translation_mm, (view->rotation * ray).normalized());
      ASSERT_TRUE(shown);
      ++checked;
      const double expected_mm = (*shown - p).norm();
      if (std::abs(expected_mm - static_cast<double>(made.difference.displacement_mm[i])) > 0.02) ++beside;
    }
  }
  ::testing::Test::RecordProperty("ventricle_mean_mm", std::to_string(sum_mm / static_cast<double>(texels)));
  EXPECT_GT(checked, 60U);
  EXPECT_LE(beside, checked / 50) << "single rays that pass a fold's edge in float or in double only";
  EXPECT_GT(sum_mm / static_cast<double>(texels), 0.5);
  EXPECT_LT(sum_mm / static_cast<double>(texels), 2);
}

TEST(DifferenceMap, KeepsTheNewestViewWhereViewsOverlap) {
  const Surface plane = slanted(20, 0.4);
  const ScopeModel scope = scenes::scope();
  const AtlasLayout layout = *build_atlas(plane.mesh, {.texel_mm = 0.3});
  DifferenceMap map = DifferenceMap::create(plane, scope, layout, SeenFrom::outside).value();
  ASSERT_TRUE(map.add({}));
  const ModeDifference first = map.figures();
  // Square to the plane nothing is displaced: over the first view that is what is left.
  Pose<M, C> square;
  square.rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-0.4, 0, 1).normalized())
          .toRotationMatrix();
  square.translation_mm = Eigen::Vector3d(0, 0, 20) - 20 * square.rotation.col(2);
  ASSERT_TRUE(map.add(square));
  const ModeDifference both = map.figures();
  EXPECT_GT(first.mean_mm, 1);
  EXPECT_LT(both.mean_mm, 0.6 * first.mean_mm);
  const AtlasPicture colours = map.colours();
  for (std::size_t i = 0; i < both.displacement_mm.size(); ++i)
    if (layout.inside[i] != 0) {
      ASSERT_EQ(colours.rgba[4 * i + 3] > 0, both.displacement_mm[i] >= 0);
    } else if (layout.owners[i].triangle == TexelOwner{}.triangle) {
      ASSERT_EQ(colours.rgba[4 * i + 3], 0) << "no chart, no colour";
    }
  const Picture seen = map.picture(square);
  const std::size_t middle = 4 * (240 * 640 + 320);
  EXPECT_GT(seen.rgba[middle], 240) << "yellow";
  EXPECT_LT(seen.rgba[middle + 2], 60);
}

}  // namespace
}  // namespace orcart
