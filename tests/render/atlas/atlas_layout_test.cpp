// The layout's promises, each checked by brute force on small surfaces.
#include "render/atlas/atlas_layout.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

/// A stair that winds round twice and a half: its projection along the axis lies over itself.
Surface winding_stair() {
  Surface surface;
  constexpr std::uint32_t kSteps = 120;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    const double angle = 5 * std::numbers::pi * i / kSteps;
    for (const double radius_mm : {4.0, 9.0}) {
      surface.mesh.vertices_mm.emplace_back(static_cast<float>(radius_mm * std::cos(angle)),
                                            static_cast<float>(radius_mm * std::sin(angle)),
                                            static_cast<float>(0.8 * angle));
    }
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    surface.mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
    surface.mesh.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
  }
  return surface;
}

AtlasLayout layout_of(const Surface& surface, const AtlasSettings& settings = {}) {
  auto layout = build_atlas(surface.mesh, settings);
  EXPECT_TRUE(layout.has_value()) << layout.error().message;
  return std::move(*layout);
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// How far inside all three edges a point lies, texels; negative outside.
double depth_inside(const std::array<Eigen::Vector2f, 3>& corners, const Eigen::Vector2d& p) {
  double depth = INFINITY;
  const double turn =
      cross((corners[1] - corners[0]).cast<double>(), (corners[2] - corners[0]).cast<double>());
  for (std::size_t e = 0; e < 3; ++e) {
    const Eigen::Vector2d a = corners[e].cast<double>(), edge = corners[(e + 1) % 3].cast<double>() - a;
    depth = std::min(depth, std::copysign(1.0, turn) * cross(edge, p - a) / edge.norm());
  }
  return depth;
}

template <class Visit>
void for_each_texel_centre(const AtlasLayout& layout, const ChartRect& rect, Visit visit) {
  for (int y = rect.y; y < rect.y + rect.height; ++y)
    for (int x = rect.x; x < rect.x + rect.width; ++x)
      visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(layout.width_texels) +
                static_cast<std::size_t>(x),
            Eigen::Vector2d(x + 0.5, y + 0.5));
}

class AtlasLayoutOf : public ::testing::TestWithParam<Surface (*)()> {};
INSTANTIATE_TEST_SUITE_P(Surfaces, AtlasLayoutOf,
                         ::testing::Values(
                             [] {
                               return scenes::sphere({3, -2, 5}, 12, 20);
                             },
                             [] { return scenes::plane(20, 30, 7); }, winding_stair));

TEST_P(AtlasLayoutOf, IsTheSameBitForBitEachTime) {
  const Surface surface = GetParam()();
  const AtlasLayout a = layout_of(surface), b = layout_of(surface);
  EXPECT_EQ(a.width_texels, b.width_texels);
  EXPECT_EQ(a.chart_of_triangle, b.chart_of_triangle);
  EXPECT_EQ(a.inside, b.inside);
  for (std::size_t i = 0; i < a.owners.size(); ++i) {
    ASSERT_EQ(a.owners[i].triangle, b.owners[i].triangle);
    ASSERT_EQ(a.owners[i].b1, b.owners[i].b1);
    ASSERT_EQ(a.owners[i].b2, b.owners[i].b2);
  }
}

TEST_P(AtlasLayoutOf, CoversNoTexelTwice) {
  const Surface surface = GetParam()();
  const AtlasLayout layout = layout_of(surface);
  std::vector<int> covers(layout.owners.size(), 0);
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    for_each_texel_centre(
        layout, layout.charts[layout.chart_of_triangle[t]],
        [&](std::size_t i, const auto& p) { covers[i] += depth_inside(layout.corners_texels[t], p) > 0.02; });
  }
  EXPECT_EQ(*std::max_element(covers.begin(), covers.end()), 1);
}

TEST_P(AtlasLayoutOf, KeepsEachTriangleAGutterAwayFromTheEdgeOfItsChart) {
  const Surface surface = GetParam()();
  const AtlasLayout layout = layout_of(surface);
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    const ChartRect& rect = layout.charts[layout.chart_of_triangle[t]];
    for (const Eigen::Vector2f& corner : layout.corners_texels[t]) {
      EXPECT_GE(corner.x(), rect.x + 2);
      EXPECT_GE(corner.y(), rect.y + 2);
      EXPECT_LE(corner.x(), rect.x + rect.width - 2);
      EXPECT_LE(corner.y(), rect.y + rect.height - 2);
    }
  }
}

TEST_P(AtlasLayoutOf, GivesEveryTexelWithinTheGutterToATriangleOfItsChart) {
  const Surface surface = GetParam()();
  const AtlasLayout layout = layout_of(surface);
  for (std::size_t c = 0; c < layout.charts.size(); ++c) {
    for_each_texel_centre(layout, layout.charts[c], [&](std::size_t i, const auto&) {
      if (layout.inside[i] == 0) return;
      for (const int dy : {-1, 0, 1})
        for (const int dx : {-1, 0, 1}) {
          const TexelOwner& owner =
              layout.owners[i + static_cast<std::size_t>(dy * layout.width_texels + dx)];
          ASSERT_NE(owner.triangle, 0xFFFFFFFF);
          ASSERT_EQ(layout.chart_of_triangle[owner.triangle], c);
        }
    });
  }
}

TEST_P(AtlasLayoutOf, LaysNoChartOverAnother) {
  const AtlasLayout layout = layout_of(GetParam()());
  std::vector<int> covers(layout.owners.size(), 0);
  for (const ChartRect& rect : layout.charts)
    for_each_texel_centre(layout, rect, [&](std::size_t i, const auto&) { ++covers[i]; });
  EXPECT_EQ(*std::max_element(covers.begin(), covers.end()), 1);
}

TEST_P(AtlasLayoutOf, FindsEachTexelsCentreAgainFromItsWeights) {
  const AtlasLayout layout = layout_of(GetParam()());
  for (std::size_t i = 0; i < layout.owners.size(); ++i) {
    const TexelOwner& owner = layout.owners[i];
    if (owner.triangle == 0xFFFFFFFF) continue;
    const auto& corners = layout.corners_texels[owner.triangle];
    const Eigen::Vector2f p =
        corners[0] + owner.b1 * (corners[1] - corners[0]) + owner.b2 * (corners[2] - corners[0]);
    const auto width = static_cast<std::size_t>(layout.width_texels);
    ASSERT_NEAR(p.x(), static_cast<float>(i % width) + 0.5F, 0.01);
    ASSERT_NEAR(p.y(), static_cast<float>(i / width) + 0.5F, 0.01);
    if (layout.inside[i] != 0) {
      ASSERT_GE(std::min({owner.b1, owner.b2, 1 - owner.b1 - owner.b2}), -1e-5F);
    }
  }
}

TEST(AtlasLayout, ReachesTheWishedSizeOfTexelOnAPlane) {
  const Surface surface = scenes::plane(20, 30, 7);
  const AtlasLayout layout = layout_of(surface, {.texel_mm = 0.25});
  EXPECT_EQ(layout.texel_mm, 0.25);
  const auto& corners = layout.corners_texels[0];
  EXPECT_NEAR((corners[0] - corners[1]).norm() * 0.25, 30.0 / 7, 1e-3);
}

TEST(AtlasLayout, ShrinksNoEdgeBelowTheCosineOfTheNormalLimit) {
  const Surface surface = scenes::sphere({0, 0, 0}, 12, 20);
  const AtlasLayout layout = layout_of(surface);
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto &a = surface.mesh.vertices_mm[surface.mesh.triangles[t][e]],
                 &b = surface.mesh.vertices_mm[surface.mesh.triangles[t][(e + 1) % 3]];
      const double texels = (layout.corners_texels[t][e] - layout.corners_texels[t][(e + 1) % 3]).norm();
      const double ratio = texels * layout.texel_mm / (a - b).norm();
      EXPECT_LE(ratio, 1.001);
      EXPECT_GE(ratio, 0.6);
    }
  }
}

TEST(AtlasLayout, IsMadeCoarserAndSaysSoWhereTheSurfaceWouldNotFit) {
  const Surface surface = scenes::plane(20, 400, 20);
  const AtlasLayout layout = layout_of(surface, {.texel_mm = 0.2, .max_size_texels = 512});
  EXPECT_LE(layout.width_texels, 512);
  EXPECT_LE(layout.height_texels, 512);
  EXPECT_GT(layout.texel_mm, 400.0 / 512);
  EXPECT_LT(layout.texel_mm, 3 * 400.0 / 512);
}

TEST(AtlasLayout, OfASurfaceWithoutTrianglesIsRefused) {
  const auto layout = build_atlas({}, {});
  ASSERT_FALSE(layout.has_value());
  EXPECT_NE(layout.error().message.find("no triangles"), std::string::npos);
}

TEST(AtlasLayout, PassesOverTrianglesWithoutArea) {
  Surface surface = scenes::plane(20, 10, 2);
  surface.mesh.triangles.push_back({0, 0, 1});
  surface.mesh.triangles.push_back({0, 1, 2});  // on one line
  const AtlasLayout layout = layout_of(surface);
  for (const TexelOwner& owner : layout.owners)
    EXPECT_TRUE(owner.triangle == 0xFFFFFFFF || owner.triangle < 8);
}

}  // namespace
}  // namespace orcart
