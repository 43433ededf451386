// Occlusion of single triangles behind a plate, and what is traced for it.
#include "realtime/mapper/occlusion.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/geometry/analytic_meshes.hpp"

namespace orcart {
namespace {

using Corners = std::array<Eigen::Vector3f, 3>;
using Ids = std::array<std::uint32_t, 3>;

const Corners kBehind{{{0, 1, 20}, {5, 0, 20}, {0, 5, 20}}};

/// A plate of 20 mm at z = 10 hides what lies behind it from the origin.
class OcclusionTest : public ::testing::Test {
 protected:
  RayScene plate_ = RayScene::create(testing::plane_grid(10, 1, 10)).value();
  Occlusion occlusion_{8};

  /// Asks for one triangle, as a cluster of its own.
  bool hidden(const Ids& ids, const Corners& at) { return hidden(plate_, ids, at); }
  bool hidden(const RayScene& surface, const Ids& ids, const Corners& at) {
    const std::array<float, 3> x{at[0].x(), at[1].x(), at[2].x()}, y{at[0].y(), at[1].y(), at[2].y()},
        z{at[0].z(), at[1].z(), at[2].z()};
    const std::array<std::array<std::uint8_t, 3>, 1> corners{{{0, 1, 2}}};
    const std::array<std::uint32_t, 1> triangle{7};
    return occlusion_.hidden(
               surface,
               {.x = x, .y = y, .z = z, .vertex_ids = ids, .corners = corners, .triangle_ids = triangle},
               1) != 0;
  }
};

TEST_F(OcclusionTest, HidesATriangleWhollyBehind) {
  occlusion_.begin({0, 0, 0});
  EXPECT_TRUE(hidden({0, 1, 2}, kBehind));
}

TEST_F(OcclusionTest, KeepsATriangleWithACornerInSight) {
  occlusion_.begin({0, 0, 0});
  EXPECT_FALSE(hidden({0, 1, 2}, Corners{{{0, 1, 20}, {5, 0, 20}, {0, 25, 20}}}));
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
  EXPECT_FALSE(hidden(surface, {0, 1, 2}, Corners{{{-12, -12, 20}, {12, -12, 20}, {0, 24, 20}}}));
  EXPECT_EQ(occlusion_.rays(), 4U);
}

TEST_F(OcclusionTest, KeepsWhatLiesOnThePlateItself) {
  occlusion_.begin({0, 0, 0});
  EXPECT_FALSE(hidden({0, 1, 2}, Corners{{{-10, -10, 10}, {-10, 10, 10}, {10, -10, 10}}}));
}

TEST_F(OcclusionTest, TracesEachVertexOnceAView) {
  occlusion_.begin({0, 0, 0});
  hidden({0, 1, 2}, kBehind);
  EXPECT_EQ(occlusion_.rays(), 4U);
  hidden({2, 1, 0}, kBehind);
  EXPECT_EQ(occlusion_.rays(), 5U);  // the centroid's alone
}

TEST_F(OcclusionTest, ForgetsTheViewBefore) {
  occlusion_.begin({0, 0, 0});
  ASSERT_TRUE(hidden({0, 1, 2}, kBehind));
  occlusion_.begin({0, 0, 15});
  EXPECT_FALSE(hidden({0, 1, 2}, kBehind));
}

}  // namespace
}  // namespace orcart
