// Simulated tissue: pure, plausible, the same on the surface as baked; and the code that tells a place.
#include "board/sim/tissue.hpp"

#include <gtest/gtest.h>

#include "board/sim/baked_tissue.hpp"
#include "board/sim/lattice_noise.hpp"
#include "tests/board/sim/test_shapes.hpp"

namespace orcart {
namespace {

Eigen::Vector3f point(int i) {
  const auto number = [&](std::uint32_t axis) {
    return static_cast<float>(hash32(3 * static_cast<std::uint32_t>(i) + axis) % 60'000) / 1000 - 30;
  };
  return {number(0), number(1), number(2)};
}

TEST(Tissue, DependsOnThePointAndTheSeedAlone) {
  const Eigen::Vector3f p(3.1F, -7.7F, 12.4F);
  EXPECT_EQ(tissue_colour(p, 5), tissue_colour(p, 5));
  EXPECT_NE(tissue_colour(p, 5), tissue_colour(p, 6));
}

TEST(Tissue, IsRedderThanGreenAndGreenerThanBlueAsFleshIs) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3f colour = tissue_colour(point(i), 1);
    EXPECT_TRUE((colour.array() >= 0).all() && (colour.array() <= 1).all());
    mean += colour / 500;
  }
  EXPECT_GT(mean.x(), 1.2F * mean.y());
  EXPECT_GT(mean.y(), 1.1F * mean.z());
}

TEST(Tissue, HasVeinsThatAreMuchDarkerThanTheGround) {
  int dark = 0;
  for (int i = 0; i < 4000; ++i) dark += tissue_colour(point(i), 1).y() < 0.2F;
  EXPECT_GT(dark, 40) << "at least one point in a hundred lies on a vein";
  EXPECT_LT(dark, 1200) << "and most do not";
}

TEST(Tissue, ChangesLittleOverAHundredthOfAMillimetreButForAFewVeinsEnds) {
  int jumps = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3f p = point(i), q = p + Eigen::Vector3f(0.006F, -0.006F, 0.005F);
    jumps += (tissue_colour(p, 1) - tissue_colour(q, 1)).norm() > 0.1F;
  }
  EXPECT_LT(jumps, 15);
}

TEST(BakedTissue, InterpolatesTheTissueItWasSampledFrom) {
  const TriangleMesh mesh = testing::ellipsoid({3, 4, 5}, 12, 16);
  const LivingTissue tissue{.seed = 3};
  const BakedTissue baked(mesh, tissue, 0.02F);
  double error = 0;
  int count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 31)
    for (float b1 : {0.0F, 0.2F, 0.61F})
      for (float b2 : {0.0F, 0.13F, 0.37F}) {
        const auto& c = mesh.triangles[t];
        const Eigen::Vector3f p = (1 - b1 - b2) * mesh.vertices_mm[c[0]] + b1 * mesh.vertices_mm[c[1]] +
                                  b2 * mesh.vertices_mm[c[2]];
        error +=
            (baked.at({.triangle = t, .b1 = b1, .b2 = b2}).colour - tissue_sample(p, tissue).colour).norm();
        ++count;
      }
  EXPECT_LT(error / count, 0.01);
}

TEST(BakedTissue, GivesTheSampleItselfAtACorner) {
  const TriangleMesh mesh = testing::ellipsoid({3, 4, 5}, 12, 16);
  const LivingTissue tissue{.seed = 3};
  const BakedTissue baked(mesh, tissue, 0.3F);
  for (const auto& [b1, b2, corner] : {std::tuple{0.0F, 0.0F, 0}, {1.0F, 0.0F, 1}, {0.0F, 1.0F, 2}}) {
    const auto vertex = mesh.triangles[40][static_cast<std::size_t>(corner)];
    const Eigen::Vector3f truth = tissue_sample(mesh.vertices_mm[vertex], tissue).colour;
    EXPECT_LT((baked.at({.triangle = 40, .b1 = b1, .b2 = b2}).colour - truth).cwiseAbs().maxCoeff(), 0.006F);
  }
}

TEST(CodedTissue, IsAWaveAlongItsAxis) {
  const CodedTissue code{.axis = 1, .period_mm = 40, .phase_rad = 0};
  EXPECT_NEAR(coded_grey({99, 0, -3}, code), 0.5, 1e-6);
  EXPECT_NEAR(coded_grey({-5, 10, 0}, code), 0.95, 1e-6);
  EXPECT_NEAR(coded_grey({0, 30, 7}, code), 0.05, 1e-6);
  EXPECT_NEAR(coded_grey({0, 0, 0}, {.axis = 2, .period_mm = 40, .phase_rad = std::numbers::pi / 2}), 0.95,
              1e-6);
}

}  // namespace
}  // namespace orcart
