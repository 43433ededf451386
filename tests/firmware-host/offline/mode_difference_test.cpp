// Paper mode against perspective: the closed form on a slanted plane, nothing where all is of one depth, more
// where it is not.
#include "firmware-host/offline/mode_difference.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "realtime/mapper/mapper.hpp"
#include "tests/render/support/scenes.hpp"

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

}  // namespace
}  // namespace orcart
