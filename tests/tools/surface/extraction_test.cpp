// A smooth ball comes out as a closed ball of the right size, at the right place, facing outward.
#include "tools/surface/extraction.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_checks.hpp"

namespace orcart {
namespace {

/// A ball of 12 mm about (5, -3, 40) mm on a grid of 1 x 1 x 2 mm; `mirrored` makes the grid's axes
/// left-handed.
SoftMask ball(bool mirrored) {
  SoftMask mask{.lattice = {.size = {40, 40, 24},
                            .origin_mm = {-15, -23, 16},
                            .step_mm = {PlainPoint{1, 0, 0}, PlainPoint{0, 1, 0}, PlainPoint{0, 0, 2}}},
                .values = {}};
  if (mirrored) {
    mask.lattice.origin_mm[0] = 25;
    mask.lattice.step_mm[0][0] = -1;
  }
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i) {
        const PlainPoint place = place_of(mask.lattice, {1.0 * i, 1.0 * j, 1.0 * k});
        const double x = place[0] - 5, y = place[1] + 3, z = place[2] - 40;
        mask.values.push_back(
            static_cast<float>(std::clamp((12.5 - std::sqrt(x * x + y * y + z * z)), 0.0, 1.0)));
      }
  return mask;
}

class Extracting : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Axes, Extracting, testing::Bool());

TEST_P(Extracting, ABallKeepsItsPlaceSizeAndFacing) {
  const auto made = extract_surface(ball(GetParam()), {.triangles = 1000});
  ASSERT_TRUE(made) << made.error().message;
  const TriangleMesh* mesh = &made->mesh;
  EXPECT_GT(made->cut_triangles, 3000U);
  EXPECT_GT(made->thinning.max_mm, 0.005);
  EXPECT_LT(made->thinning.max_mm, 0.3);
  EXPECT_LT(made->smoothing_max_mm, 1.5);  // of a grid of 2 mm
  EXPECT_LE(mesh->triangles.size(), 1000U);
  EXPECT_TRUE(checks::is_closed(*mesh));
  const double exact_mm3 = 4.0 / 3 * std::numbers::pi * 12 * 12 * 12;
  EXPECT_NEAR(checks::signed_volume_mm3(*mesh), exact_mm3, 0.03 * exact_mm3);
  for (const auto& vertex : mesh->vertices_mm)
    EXPECT_NEAR((vertex - Eigen::Vector3f(5, -3, 40)).norm(), 12, 0.5);
}

TEST(Extraction, OnlyTheLargestPieceIsKept) {
  SoftMask mask = ball(false);
  mask.values[2 + 40 * (2 + 40 * 2)] = 1;
  const auto made = extract_surface(mask, {.triangles = 4000});
  ASSERT_TRUE(made);
  for (const auto& vertex : made->mesh.vertices_mm)
    EXPECT_LT((vertex - Eigen::Vector3f(5, -3, 40)).norm(), 14);
}

TEST(Extraction, APieceIsTakenByItsSize) {
  SoftMask mask = ball(false);
  mask.values[2 + 40 * (2 + 40 * 2)] = 1;
  const auto second = extract_surface(mask, {.pieces = {.kind = PieceChoice::Kind::numbered, .number = 2}});
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->mesh.triangles.size(), 8U);  // one voxel: an octahedron
  const auto third = extract_surface(mask, {.pieces = {.kind = PieceChoice::Kind::numbered, .number = 3}});
  ASSERT_FALSE(third);
  EXPECT_NE(third.error().message.find("1 to 2 are accepted"), std::string::npos);
}

TEST(Extraction, ARegionThatVanishedSaysSo) {
  SoftMask mask = ball(false);
  std::fill(mask.values.begin(), mask.values.end(), 0.4F);
  const auto mesh = extract_surface(mask, {});
  ASSERT_FALSE(mesh);
  EXPECT_NE(mesh.error().message.find("vanished"), std::string::npos);
}

}  // namespace
}  // namespace orcart
