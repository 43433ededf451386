// Triangles against the viewing cone: each way to touch it by hand, and thousands against a reference.
#include "realtime/geometry/viewing_cone.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/realtime/geometry/cone_reference.hpp"

namespace orcart {
namespace {

using Corners = std::array<Eigen::Vector3f, 3>;

constexpr ConeShape kShape{.half_angle_rad = 0.5, .far_mm = 60};  // tan 0.5463: 5.463 mm wide at 10 mm
const ViewingCone kCone = viewing_cone({}, kShape);

TEST(ViewingCone, MeetsATriangleWithACornerInside) {
  EXPECT_TRUE(meets_cone(kCone, Corners{{{0, 0, 10}, {100, 0, 10}, {100, 1, 10}}}));
}

TEST(ViewingCone, MeetsATriangleThatOnlyTheAxisPierces) {
  EXPECT_TRUE(meets_cone(kCone, Corners{{{-50, -50, 10}, {50, -50, 10}, {0, 80, 10}}}));
  EXPECT_FALSE(meets_cone(kCone, Corners{{{-50, -50, -10}, {50, -50, -10}, {0, 80, -10}}}));
  EXPECT_FALSE(meets_cone(kCone, Corners{{{-50, -50, 61}, {50, -50, 61}, {0, 80, 61}}}));
}

TEST(ViewingCone, MeetsATriangleThatOnlyAnEdgeCrosses) {
  EXPECT_TRUE(meets_cone(kCone, Corners{{{-50, 5, 10}, {50, 5, 10}, {0, 80, 10}}}));
  EXPECT_FALSE(meets_cone(kCone, Corners{{{-50, 5.6F, 10}, {50, 5.6F, 10}, {0, 80, 10}}}));
}

TEST(ViewingCone, MeetsATriangleThroughItsApex) {
  EXPECT_TRUE(meets_cone(kCone, Corners{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}}));
}

TEST(ViewingCone, CutsTrianglesAtTheFarPlaneFirst) {
  // Beyond 60 mm the triangle lies in the cone; before it, outside.
  EXPECT_FALSE(meets_cone(kCone, Corners{{{40, 0, 50}, {40, 0, 90}, {45, 0, 50}}}));
  EXPECT_TRUE(meets_cone(kCone, Corners{{{30, 0, 50}, {30, 0, 90}, {45, 0, 50}}}));
}

TEST(ViewingCone, MeetsTrianglesWithoutArea) {
  EXPECT_TRUE(meets_cone(kCone, Corners{{{1, 1, 10}, {1, 1, 10}, {1, 1, 10}}}));
  EXPECT_TRUE(meets_cone(kCone, Corners{{{-9, 1, 10}, {9, 1, 10}, {0, 1, 10}}}));
  EXPECT_FALSE(meets_cone(kCone, Corners{{{9, 1, 10}, {9, 1, 10}, {9, 1, 10}}}));
}

TEST(ViewingCone, AgreesWithSubdivisionOnTrianglesOfAllShapes) {
  std::mt19937 random(7);
  std::normal_distribution<float> spread(0, 1);
  std::uniform_real_distribution<float> exponent(-1, 2);
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    Corners corners;
    const Eigen::Vector3f at(30 * spread(random), 30 * spread(random), 30 + 30 * spread(random));
    for (auto& corner : corners)
      corner = at + std::pow(10.F, exponent(random)) *
                        Eigen::Vector3f(spread(random), spread(random), spread(random));
    const double depth = testing::deepest_in_cone(
        {corners[0].cast<double>(), corners[1].cast<double>(), corners[2].cast<double>()}, kShape, 1e-3);
    if (std::abs(depth) < 2e-3) continue;  // too near to call for the reference
    met += depth > 0 ? 1 : 0;
    EXPECT_EQ(meets_cone(kCone, corners), depth > 0) << "triangle " << i << " reaches " << depth;
  }
  EXPECT_GT(met, 4000);
  EXPECT_LT(met, 16000);
}

}  // namespace
}  // namespace orcart
