// A cube's figures are a cube's, and each kind of trouble is found and told.
#include "tools/mesh/mesh_figures.hpp"

#include <gtest/gtest.h>

#include "tests/tools/mesh/shapes.hpp"
#include "tools/mesh/mesh_components.hpp"

namespace orcart {
namespace {

TEST(MeshFigures, OfACube) {
  const auto figures = measure_mesh(cube(10));
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->vertices, 8U);
  EXPECT_EQ(figures->edges, 18U);
  EXPECT_EQ(figures->euler_number, 2);
  EXPECT_NEAR(figures->area_mm2, 600, 1e-9);
  EXPECT_NEAR(figures->volume_ml, 1, 1e-12);
  EXPECT_EQ(figures->components, 1U);
  EXPECT_FALSE(trouble_of(*figures));
}

TEST(MeshFigures, TwoCubesApartAreTwoPiecesAndNoTrouble) {
  const auto figures = measure_mesh(both(cube(10), cube(5, {20, 0, 0})));
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->components, 2U);
  EXPECT_EQ(figures->euler_number, 4);
  EXPECT_FALSE(trouble_of(*figures));
}

TEST(MeshFigures, CubesThatGoThroughEachOtherAreFound) {
  const auto figures = measure_mesh(both(cube(10), cube(10, {5.5F, 5.2F, 5.1F})));
  ASSERT_TRUE(figures);
  EXPECT_GE(figures->piercing_edges, 6U);
  ASSERT_TRUE(trouble_of(*figures));
  EXPECT_NE(trouble_of(*figures)->find("goes through itself"), std::string::npos);
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

TEST(MeshFigures, APieceThatIsInsideOutIsFound) {
  const auto figures = measure_mesh(both(cube(10), inside_out(cube(5, {20, 0, 0}))));
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->inverted_components, 1U);
  ASSERT_TRUE(trouble_of(*figures));
  EXPECT_NE(trouble_of(*figures)->find("1 of its pieces are inside out"), std::string::npos);
  EXPECT_GE(figures->inverted_at_mm.x(), 20);
}

TEST(MeshFigures, AHollowAndWhatLiesInItAreNoTrouble) {
  const TriangleMesh hollow = both(cube(10), inside_out(cube(6, {2, 2, 2})));
  const auto figures = measure_mesh(both(hollow, cube(2, {4, 4, 4})));
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->components, 3U);
  EXPECT_EQ(figures->inverted_components, 0U);
  EXPECT_FALSE(trouble_of(*figures));
  const auto inverted = measure_mesh(both(hollow, inside_out(cube(2, {4, 4, 4}))));
  ASSERT_TRUE(inverted);
  EXPECT_EQ(inverted->inverted_components, 1U) << "nothing is left to be hollow within a hollow";
}

TEST(MeshFigures, AHoleIsFound) {
  TriangleMesh open = cube(10);
  open.triangles.pop_back();
  const auto figures = measure_mesh(open);
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->open_edges, 3U);
  EXPECT_NE(trouble_of(*figures)->find("open along 3 edges"), std::string::npos);
}

TEST(MeshFigures, ATurnedTriangleIsFound) {
  TriangleMesh turned = cube(10);
  std::swap(turned.triangles[0][1], turned.triangles[0][2]);
  const auto figures = measure_mesh(turned);
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->misturned_edges, 3U);
  EXPECT_NE(trouble_of(*figures)->find("face opposite ways"), std::string::npos);
}

TEST(MeshComponents, AreNumberedByTheirTriangles) {
  TriangleMesh smaller = cube(5, {20, 0, 0});
  smaller.triangles.resize(6);
  const TriangleMesh mesh = both(smaller, cube(10));
  const MeshComponents pieces = components_of(mesh);
  ASSERT_EQ(pieces.triangles, (std::vector<std::size_t>{12, 6}));
  EXPECT_EQ(component(mesh, pieces, 0).vertices_mm.size(), 8U);
  EXPECT_EQ(component(mesh, pieces, 1).triangles.size(), 6U);
}

}  // namespace
}  // namespace orcart
