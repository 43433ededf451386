// Occlusion of single triangles behind a plate, and what is traced for it.
#include "realtime/mapper/occlusion.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/geometry/analytic_meshes.hpp"

namespace orcart {
namespace {

using Corners = std::array<Eigen::Vector3f, 3>;

const Corners kBehind{{{0, 1, 20}, {5, 0, 20}, {0, 5, 20}}};

/// A plate of 20 mm at z = 10 hides what lies behind it from the origin.
class OcclusionTest : public ::testing::Test {
 protected:
  RayScene plate_ = RayScene::create(testing::plane_grid(10, 1, 10)).value();
  Occlusion occlusion_{8};
};

TEST_F(OcclusionTest, HidesATriangleWhollyBehind) {
  occlusion_.begin({0, 0, 0});
  EXPECT_TRUE(occlusion_.hidden(plate_, {0, 1, 2}, kBehind));
}

TEST_F(OcclusionTest, KeepsATriangleWithACornerInSight) {
  occlusion_.begin({0, 0, 0});
  EXPECT_FALSE(occlusion_.hidden(plate_, {0, 1, 2}, Corners{{{0, 1, 20}, {5, 0, 20}, {0, 25, 20}}}));
}

TEST_F(OcclusionTest, KeepsATriangleWithOnlyItsCentroidInSight) {
  const TriangleMesh left = testing::plane_grid(1, 1, 10);
  TriangleMesh spots = left;
  for (const Eigen::Vector3f& at : {Eigen::Vector3f(-6, -6, 0), {6, -6, 0}, {0, 12, 0}}) {
    TriangleMesh spot = left;
    for (auto& v : spot.vertices_mm) v += at;
    spots = at.x() == -6 ? spot : testing::joined(spots, spot);
  }
  const RayScene surface = RayScene::create(spots).value();
  occlusion_.begin({0, 0, 0});
  EXPECT_FALSE(occlusion_.hidden(surface, {0, 1, 2}, Corners{{{-12, -12, 20}, {12, -12, 20}, {0, 24, 20}}}));
  EXPECT_EQ(occlusion_.rays(), 4U);
}

TEST_F(OcclusionTest, KeepsWhatLiesOnThePlateItself) {
  occlusion_.begin({0, 0, 0});
  EXPECT_FALSE(occlusion_.hidden(plate_, {0, 1, 2}, Corners{{{-10, -10, 10}, {-10, 10, 10}, {10, -10, 10}}}));
}

TEST_F(OcclusionTest, TracesEachVertexOnceAView) {
  occlusion_.begin({0, 0, 0});
  occlusion_.hidden(plate_, {0, 1, 2}, kBehind);
  EXPECT_EQ(occlusion_.rays(), 4U);
  occlusion_.hidden(plate_, {2, 1, 0}, kBehind);
  EXPECT_EQ(occlusion_.rays(), 5U);  // the centroid's alone
}

TEST_F(OcclusionTest, ForgetsTheViewBefore) {
  occlusion_.begin({0, 0, 0});
  ASSERT_TRUE(occlusion_.hidden(plate_, {0, 1, 2}, kBehind));
  occlusion_.begin({0, 0, 15});
  EXPECT_FALSE(occlusion_.hidden(plate_, {0, 1, 2}, kBehind));
}

}  // namespace
}  // namespace orcart
