// Normals that follow from the triangles: by hand, in every format that carries them, and told where a file's
// own contradict its triangles.
#include "firmware-host/files/vertex_normals.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

/// A corner of a cube: three squares about the origin; the one across z is cut into two triangles there, the
/// others are one triangle there.
TriangleMesh cube_corner() {
  TriangleMesh mesh;
  mesh.vertices_mm = {{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {-1, -1, 0}};
  mesh.triangles = {{0, 1, 4}, {0, 4, 2}, {0, 3, 1}, {0, 2, 3}};
  return mesh;
}

TEST(VertexNormals, DoNotDependOnHowAFaceIsCut) {
  const auto normals = angle_weighted_normals(cube_corner());
  // x, y and z each stand at a right angle there.
  EXPECT_LT((normals[0] - Eigen::Vector3f::Ones().normalized()).norm(), 1e-6F);
  EXPECT_LT((normals[4] - Eigen::Vector3f::UnitZ()).norm(), 1e-6F);
}

TEST(VertexNormals, OfAVertexWithoutAreaAreUpright) {
  TriangleMesh mesh = cube_corner();
  mesh.vertices_mm.emplace_back(5, 5, 5);
  mesh.vertices_mm.emplace_back(6, 5, 5);
  mesh.vertices_mm.emplace_back(7, 5, 5);
  mesh.triangles.push_back({5, 6, 7});
  EXPECT_EQ(angle_weighted_normals(mesh)[6], Eigen::Vector3f::UnitZ());
}

TEST(VertexNormals, AreWrittenIntoPly) {
  const TemporaryFolder folder;
  const Surface surface = make_surface(cube_corner(), "corner").value();
  ASSERT_TRUE(write_ply(folder / "s.ply", surface));
  std::stringstream bytes;
  bytes << std::ifstream(folder / "s.ply", std::ios::binary).rdbuf();
  const std::string ply = bytes.str();
  EXPECT_NE(ply.find("property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"),
            std::string::npos);
  Eigen::Vector3f first;
  std::memcpy(first.data(), ply.data() + ply.find("end_header\n") + 11 + 12, 12);
  EXPECT_LT((first - Eigen::Vector3f::Ones().normalized()).norm(), 1e-6F);
  const auto back = read_surface(folder / "s.ply");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->identity.hash, surface.identity.hash);
}

/// A triangle whose corners run counter-clockwise from +z, with its normals as told.
std::string triangle_with(const std::string& normal) {
  return "ply\nformat ascii 1.0\ncomment SPACE=LPS\nelement vertex 3\nproperty float nx\nproperty float ny\n"
         "property float nz\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n" +
         normal + " 0 0 0\n" + normal + " 1 0 0\n" + normal + " 0 1 0\n3 0 1 2\n";
}

TEST(VertexNormals, ThatContradictAnOpenSurfaceAreTold) {
  const TemporaryFolder folder;
  for (const auto& [normal, told] : {std::pair{"0 0 1", false}, {"0 0 -1", true}}) {
    SurfaceNotes notes;
    const auto surface = read_surface(folder.write("s.ply", triangle_with(normal)), &notes);
    ASSERT_TRUE(surface) << surface.error().message;
    EXPECT_EQ(surface->mesh.triangles.front(), (std::array<std::uint32_t, 3>{0, 1, 2}));
    bool said = false;
    for (const std::string& note : notes.sentences)
      said = said || note.find("normals point against") != std::string::npos;
    EXPECT_EQ(said, told) << normal;
  }
}

TEST(VertexNormals, ThatAreHalfThereAreNoNormals) {
  const TemporaryFolder folder;
  std::string text = triangle_with("0 0 -1");
  text.replace(text.find("property float nz"), 17, "property float nw");
  SurfaceNotes notes;
  ASSERT_TRUE(read_surface(folder.write("s.ply", text), &notes));
  for (const std::string& note : notes.sentences) EXPECT_EQ(note.find("normals"), std::string::npos) << note;
}

}  // namespace
}  // namespace orcart
