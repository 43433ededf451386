// Every surface format gives the same triangles, in LPS, with their identity.
#include "firmware-host/files/surface_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "firmware-host/files/surface_checks.hpp"
#include "firmware-host/files/surface_formats.hpp"
#include "tests/firmware-host/files/surface_samples.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

void expect_tetrahedron(const Result<Surface>& surface) {
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.vertices_mm, tetrahedron().vertices_mm);
  EXPECT_EQ(surface->mesh.triangles, tetrahedron().triangles);
  EXPECT_TRUE(surface->closed);
}

template <class Number>
void append(std::string& bytes, Number number, bool big = false) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  if (big) std::reverse(raw, raw + sizeof raw);
  bytes.append(raw, sizeof raw);
}

TEST(SurfaceFile, ReadsAsciiPly) {
  const TemporaryFolder folder;
  expect_tetrahedron(read_surface(folder.write("s.ply", ascii_ply())));
}

TEST(SurfaceFile, ReadsAsciiPlyWithCrLf) {
  const TemporaryFolder folder;
  std::string text;
  for (const char c : ascii_ply()) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_tetrahedron(read_surface(folder.write("s.ply", text)));
}

TEST(SurfaceFile, ReadsBigEndianPlyWithDoublesExtrasAndAnyOrder) {
  const TemporaryFolder folder;
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\ncomment SPACE=LPS\nelement vertex 4\nproperty double z\nproperty "
      "uchar red\n"
      "property double x\nproperty list uchar short marks\nproperty double y\nelement edge 1\nproperty int "
      "v\n"
      "element face 4\nproperty uchar flag\nproperty list ushort uint vertex_index\n"
      "property list uchar float texcoord\nend_header\n";
  for (const TriangleMesh mesh = tetrahedron(); const auto& v : mesh.vertices_mm) {
    append<double>(bytes, v.z(), true);
    bytes += '\x7f';
    append<double>(bytes, v.x(), true);
    append<std::uint8_t>(bytes, 2);
    append<std::int16_t>(bytes, -5, true);
    append<std::int16_t>(bytes, 5, true);
    append<double>(bytes, v.y(), true);
  }
  append<std::int32_t>(bytes, 9, true);
  for (const TriangleMesh mesh = tetrahedron(); const auto& t : mesh.triangles) {
    append<std::uint8_t>(bytes, 1);
    append<std::uint16_t>(bytes, 3, true);
    for (const auto i : t) append<std::uint32_t>(bytes, i, true);
    append<std::uint8_t>(bytes, 1);
    append<float>(bytes, 0.5F, true);
  }
  expect_tetrahedron(read_surface(folder.write("s.ply", bytes)));
}

TEST(SurfaceFile, WrittenPlyIsReadBackToTheBit) {
  const TemporaryFolder folder;
  auto surface = make_surface(tetrahedron(), "made");
  ASSERT_TRUE(surface);
  surface->mesh.vertices_mm[1].x() = 0.1F;
  surface->identity.series = "1.2.840 \nT1 axial";
  surface->identity.frame_of_reference = "1.2.3";
  ASSERT_TRUE(write_ply(folder / "s.ply", *surface));
  const auto read = read_surface(folder / "s.ply");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mesh.vertices_mm, surface->mesh.vertices_mm);
  EXPECT_EQ(read->mesh.triangles, surface->mesh.triangles);
  EXPECT_EQ(read->identity.series, "1.2.840  T1 axial");
  EXPECT_EQ(read->identity.frame_of_reference, "1.2.3");
  EXPECT_EQ(read->identity.hash.size(), 32U);
  EXPECT_EQ(folder.count(), 1U);
}

TEST(SurfaceFile, TheHashFollowsEveryVertexAndTriangle) {
  const auto hash = [](TriangleMesh mesh) { return make_surface(std::move(mesh), "made")->identity.hash; };
  TriangleMesh moved = tetrahedron(), turned = tetrahedron();
  moved.vertices_mm[3].z() = 3.0000002F;
  std::rotate(turned.triangles[0].begin(), turned.triangles[0].begin() + 1, turned.triangles[0].end());
  EXPECT_EQ(hash(tetrahedron()), hash(tetrahedron()));
  EXPECT_NE(hash(tetrahedron()), hash(moved));
  EXPECT_NE(hash(tetrahedron()), hash(turned));
}

TEST(SurfaceFile, ConvertsRasAsSlicerStatesIt) {
  const TemporaryFolder folder;
  const auto surface =
      read_surface(folder.write("s.ply", ascii_ply("comment 3D Slicer output. SPACE=RAS\n")));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.vertices_mm[1], Eigen::Vector3f(-1, 0, 0));
  EXPECT_EQ(surface->mesh.vertices_mm[2], Eigen::Vector3f(0, -2, 0));
  EXPECT_EQ(surface->mesh.vertices_mm[3], Eigen::Vector3f(0, 0, 3));
}

TEST(SurfaceFile, RasMakesNoMinusZero) {
  const TemporaryFolder folder;
  const auto surface = read_surface(folder.write("s.ply", ascii_ply("comment SPACE=RAS\n")));
  ASSERT_TRUE(surface);
  for (const auto& vertex : surface->mesh.vertices_mm)
    for (const float coordinate : vertex) EXPECT_FALSE(coordinate == 0 && std::signbit(coordinate));
}

TEST(SurfaceFile, AsksForASpaceThatIsNotStatedUnlessTold) {
  const TemporaryFolder folder;
  const auto file = folder.write("s.ply", ascii_ply(""));
  const auto refused = read_surface(file);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("states no coordinate system"), std::string::npos);
  expect_tetrahedron(read_surface(file, nullptr, Space::lps));
  EXPECT_EQ(read_surface(file, nullptr, Space::ras)->mesh.vertices_mm[1].x(), -1);
}

TEST(SurfaceFile, MergesTheVerticesOfAsciiStlExactly) {
  const TemporaryFolder folder;
  std::string text = "solid x SPACE=LPS\n";
  const TriangleMesh mesh = tetrahedron();
  for (const auto& t : mesh.triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const auto i : t) {
      const auto& v = mesh.vertices_mm[i];
      text += "   vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
              std::to_string(v.z()) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  const auto surface = read_surface(folder.write("s.STL", text + "endsolid x\n"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.vertices_mm.size(), 4U);
  EXPECT_TRUE(surface->closed);
}

TEST(SurfaceFile, ReadsAsciiStlInCapitalsBehindABlank) {
  const TemporaryFolder folder;
  std::string text = " SOLID X SPACE=LPS\n";
  for (const TriangleMesh mesh = tetrahedron(); const auto& t : mesh.triangles) {
    text += "FACET NORMAL 0 0 0\nOUTER LOOP\n";
    for (const auto i : t) {
      const Eigen::Vector3f v = tetrahedron().vertices_mm[i];
      text += "VERTEX " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) +
              "\n";
    }
    text += "ENDLOOP\nENDFACET\n";
  }
  const auto surface = read_surface(folder.write("s.stl", text + "ENDSOLID X\n"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_TRUE(surface->closed);
}

TEST(SurfaceFile, ANumberTooSmallForAFloatIsZero) {
  const TemporaryFolder folder;
  const auto surface =
      read_surface(folder.write("s.obj",
                                "# SPACE=LPS\nv 1e-46 0 -1.5e-300\nv 1 0 0\nv 0 2 0\nv 0 0 3\n"
                                "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.vertices_mm[0], Eigen::Vector3f(0, 0, 0));
}

TEST(SurfaceFile, TrianglesWithVerticesOfTheirOwnAreJoinedAndTold) {
  const TemporaryFolder folder;
  std::string vertices, faces;
  int count = 0;
  for (const TriangleMesh mesh = tetrahedron(); const auto& t : mesh.triangles) {
    for (const auto i : t) {
      const Eigen::Vector3f v = tetrahedron().vertices_mm[i];
      vertices += std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
    }
    faces += "3 " + std::to_string(count) + " " + std::to_string(count + 1) + " " +
             std::to_string(count + 2) + "\n";
    count += 3;
  }
  SurfaceNotes notes;
  const auto surface = read_surface(
      folder.write("s.ply",
                   "ply\nformat ascii 1.0\ncomment SPACE=LPS\nelement vertex 12\nproperty float x\n"
                   "property float y\nproperty float z\nelement face 4\n"
                   "property list uchar int vertex_indices\nend_header\n" +
                       vertices + faces),
      &notes);
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_TRUE(surface->closed);
  EXPECT_EQ(surface->mesh.vertices_mm.size(), 4U);
  EXPECT_NE(notes.sentences.at(0).find("8 vertices stood where others stand"), std::string::npos);
}

TEST(SurfaceFile, SheetsThatOnlyTouchAreNotJoined) {
  const TemporaryFolder folder;
  std::string text = "# SPACE=LPS\n";
  for (int copy = 0; copy < 2; ++copy)  // two closed tetrahedra on one edge
    for (const TriangleMesh mesh = tetrahedron(); const auto& v : mesh.vertices_mm)
      text += "v " + std::to_string(copy == 0 ? v.x() : -v.x()) + " " + std::to_string(v.y()) + " " +
              std::to_string(v.z()) + "\n";
  text += "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 5 6 7\nf 5 8 6\nf 5 7 8\nf 6 8 7\n";
  const auto surface = read_surface(folder.write("s.obj", text));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_TRUE(surface->closed);
  EXPECT_EQ(surface->mesh.vertices_mm.size(), 8U);
}

TEST(SurfaceFile, FacesOfTwoCornersAreDroppedAndTold) {
  const TemporaryFolder folder;
  SurfaceNotes notes;
  const auto surface = read_surface(folder.write("s.obj",
                                                 "# SPACE=LPS\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n"
                                                 "f 1 3 2\nf 1// 2//\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"),
                                    &notes);
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_TRUE(surface->closed);
  EXPECT_NE(notes.sentences.at(0).find("1 triangles without area were dropped"), std::string::npos);
}

TEST(SurfaceFile, AnObjLineMayGoOnBehindABackslash) {
  const TemporaryFolder folder;
  const auto surface = read_surface(folder.write("s.obj",
                                                 "# SPACE=LPS\nv 0 0 0\nv 1 0 \\\n0\nv 0 2 0\nv 0 0 3\n"
                                                 "f 1 3 \\\r\n2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_TRUE(surface->closed);
  EXPECT_EQ(surface->mesh.vertices_mm[1], Eigen::Vector3f(1, 0, 0));
}

TEST(SurfaceFile, ReadsBinaryStlEvenIfItsHeaderBeginsWithSolid) {
  const TemporaryFolder folder;
  std::string bytes = "solid SPACE=LPS";
  bytes.resize(80);
  const TriangleMesh mesh = tetrahedron();
  append<std::uint32_t>(bytes, 4);
  for (const auto& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (const auto i : t)
      for (const float x : mesh.vertices_mm[i]) append<float>(bytes, x == 0 && i == 1 ? -0.0F : x);
    bytes.append(2, '\0');
  }
  const auto surface = read_surface(folder.write("s.stl", bytes));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.vertices_mm.size(), 4U);
  EXPECT_TRUE(surface->closed);
}

TEST(SurfaceFile, FansTheFacesOfObjAndTakesNegativeIndices) {
  const TemporaryFolder folder;
  const auto surface = read_surface(folder.write(
      "s.obj",
      "# SPACE=LPS\no box\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv +0 1 0\nvt 0 0\nf 1/1/1 2//1 3/1 -1\n"));
  ASSERT_TRUE(surface) << surface.error().message;
  ASSERT_EQ(surface->mesh.triangles.size(), 2U);
  EXPECT_EQ(surface->mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_FALSE(surface->closed);
}

TEST(SurfaceFile, TellsWhatItMended) {
  TriangleMesh mesh = tetrahedron();
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  mesh.triangles.push_back({1, 1, 2});
  SurfaceNotes notes;
  const auto surface = make_surface(mesh, "made", &notes);
  ASSERT_TRUE(surface);
  ASSERT_EQ(notes.sentences.size(), 2U);
  EXPECT_EQ(notes.sentences[0], "made: 1 triangles without area were dropped");
  EXPECT_EQ(notes.sentences[1], "made: the surface was inside out; its triangles were turned");
  EXPECT_TRUE(surface->closed);
}

TEST(SurfaceFile, TellsThatASurfaceIsOpen) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  SurfaceNotes notes;
  EXPECT_FALSE(make_surface(mesh, "made", &notes)->closed);
  ASSERT_EQ(notes.sentences.size(), 1U);
  EXPECT_NE(notes.sentences[0].find("open"), std::string::npos);
}

TEST(SurfaceFile, AnInsideOutSphereWithRepeatedPolesIsClosedAndTurned) {
  constexpr std::uint32_t kRings = 8, kSides = 12;
  TriangleMesh sphere;
  for (std::uint32_t r = 0; r <= kRings; ++r)
    for (std::uint32_t s = 0; s < kSides; ++s) {
      const double down = std::numbers::pi * r / kRings, around = 2 * std::numbers::pi * s / kSides;
      const double across = r == 0 || r == kRings ? 0 : 10 * std::sin(down);  // a pole for each side
      sphere.vertices_mm.push_back(
          Eigen::Vector3d(across * std::cos(around), across * std::sin(around), 10 * std::cos(down))
              .cast<float>());
    }
  for (std::uint32_t r = 0; r < kRings; ++r)
    for (std::uint32_t s = 0; s < kSides; ++s) {
      const std::uint32_t a = r * kSides + s, b = r * kSides + (s + 1) % kSides, c = a + kSides,
                          d = b + kSides;
      sphere.triangles.push_back({a, b, c});  // clockwise from outside
      sphere.triangles.push_back({b, d, c});
    }
  SurfaceNotes notes;
  const auto surface = finish_surface({.mesh = sphere, .space = "LPS"}, "sphere", &notes, std::nullopt);
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_TRUE(surface->closed);
  EXPECT_GT(checks::signed_volume_mm3(surface->mesh), 3500);
  EXPECT_EQ(surface->mesh.vertices_mm.size(), (kRings - 1) * kSides + 2);
}

TEST(SurfaceFile, ASliverAlongASideIsJoinedWithItsNeighbourNotTornOut) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices_mm.emplace_back(0.5F, 0.0F,
                                0.0F);  // 4, between 0 and 1: one face knows it, a sliver the other
  mesh.triangles = {{0, 2, 4}, {4, 2, 1}, {0, 4, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  ASSERT_TRUE(checks::is_closed(mesh));
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);  // inside out
  SurfaceNotes notes;
  const auto surface = make_surface(mesh, "slit", &notes);
  ASSERT_TRUE(surface);
  EXPECT_TRUE(surface->closed);
  EXPECT_NEAR(checks::signed_volume_mm3(surface->mesh), 1, 1e-6);
  EXPECT_EQ(surface->mesh.triangles.size(), 6U);
  ASSERT_EQ(notes.sentences.size(), 2U);
  EXPECT_NE(notes.sentences[0].find("1 triangles without area lay along a neighbour"), std::string::npos);
  const TriangleMesh again = surface->mesh;
  EXPECT_EQ(make_surface(again, "again")->identity.hash, surface->identity.hash);
}

TEST(SurfaceFile, WhatIsClosedOnlyWithItsSliverIsStillTurned) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices_mm.emplace_back(0.0F, 0.0F,
                                0.0F);  // 4 stands where 0 stands: no neighbour makes an area of it
  mesh.triangles = {{0, 2, 1}, {4, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 1, 4}, {0, 4, 3}};
  ASSERT_TRUE(checks::is_closed(mesh));
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  const auto surface = make_surface(mesh, "split");
  ASSERT_TRUE(surface);
  EXPECT_NEAR(checks::signed_volume_mm3(surface->mesh), 1, 1e-6);
}

double area_mm2(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f ab = mesh.vertices_mm[t[1]] - mesh.vertices_mm[t[0]],
                          ac = mesh.vertices_mm[t[2]] - mesh.vertices_mm[t[0]];
    area += static_cast<double>(ab.cross(ac).norm()) / 2;
  }
  return area;
}

TEST(SurfaceFile, AConcavePolygonKeepsItsArea) {
  const TemporaryFolder folder;
  // A U, from each corner on and both ways around.
  const std::vector<std::string> corners = {"0 0 5",   "60 0 5",  "60 50 5", "40 50 5",
                                            "40 20 5", "20 20 5", "20 50 5", "0 50 5"};
  constexpr double kArea = 60 * 50 - 20 * 30;
  for (std::size_t first = 0; first < corners.size(); ++first)
    for (const bool backwards : {false, true}) {
      std::string obj = "# SPACE=LPS\n", face = "f",
                  ply = ply_header("ascii", "comment SPACE=LPS\n", "8", "1"), list = "8";
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t corner = (first + (backwards ? corners.size() - i : i)) % corners.size();
        obj += "v " + corners[i] + "\n";
        ply += corners[i] + "\n";
        face += " " + std::to_string(corner + 1);
        list += " " + std::to_string(corner);
      }
      for (const auto& file :
           {folder.write("u.obj", obj + face + "\n"), folder.write("u.ply", ply + list + "\n")}) {
        const auto surface = read_surface(file);
        ASSERT_TRUE(surface) << surface.error().message;
        EXPECT_NEAR(area_mm2(surface->mesh), kArea, 1e-3) << first << backwards;
        EXPECT_EQ(surface->mesh.triangles.size(), 6U);
        for (const auto& t : surface->mesh.triangles) {
          const auto& v = surface->mesh.vertices_mm;
          EXPECT_EQ((v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).z() > 0, !backwards);
        }
      }
    }
}

TEST(SurfaceFile, APolygonWithACornerOnASideHasNoSliver) {
  const TemporaryFolder folder;
  const auto surface = read_surface(
      folder.write("s.obj", "# SPACE=LPS\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.triangles.size(), 3U);
  EXPECT_NEAR(area_mm2(surface->mesh), 4, 1e-6);
}

}  // namespace
}  // namespace orcart
