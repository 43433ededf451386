// Surfaces that are broken, or lie about themselves: each gives one sentence, and never much memory or a
// crash.
#include <random>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/surface_formats.hpp"
#include "tests/firmware-host/files/surface_samples.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

struct Hostile {
  const char* name;
  std::string bytes;
  const char* expected;  ///< a part of the sentence
};

class HostileSurface : public testing::TestWithParam<Hostile> {};

TEST_P(HostileSurface, GivesOneSentenceThatNamesTheFile) {
  const TemporaryFolder folder;
  const auto surface = read_surface(folder.write(GetParam().name, GetParam().bytes));
  ASSERT_FALSE(surface);
  const std::string& message = surface.error().message;
  EXPECT_NE(message.find(GetParam().name), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string stl_of(std::uint32_t count, std::size_t size) {
  std::string bytes(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  bytes.resize(size);
  return bytes;
}

INSTANTIATE_TEST_SUITE_P(
    Files, HostileSurface,
    testing::Values(
        Hostile{"empty.ply", "", "is empty"},
        Hostile{"garbage.ply", "\x01\x02garbage", "PLY file is expected"},
        Hostile{"kind.vtk", "x", ".ply, .stl, .obj and .mz3 are accepted"},
        Hostile{"header.ply", "ply\nformat ascii 1.0\n", "has no end_header"},
        Hostile{"format.ply", "ply\nformat ebcdic 1.0\nend_header\n", "ply:2: \"format ebcdic 1.0\""},
        Hostile{"nothing.ply", ply_header("ascii", "", "0", "0"), "0 vertices and 0 triangles"},
        Hostile{"nan.ply", replaced(ascii_ply(), "0 2 0", "0 nan 0"), "vertex 2 is (0.000000, nan"},
        Hostile{"far.ply", replaced(ascii_ply(), "0 2 0", "0 1e30 0"), "-10000 to 10000 mm"},
        Hostile{"index.ply", replaced(ascii_ply(), "3 0 2 1", "3 0 4 1"),
                "face 0 has vertex 4; whole numbers below 4"},
        Hostile{"negative.ply", replaced(ascii_ply(), "3 0 2 1", "3 0 -1 1"), "face 0 has vertex -1"},
        Hostile{"word.ply", replaced(ascii_ply(), "1 0 0", "1 O 0"),
                "vertex 1 holds a word that is no number"},
        Hostile{"polygon.ply", replaced(ascii_ply(), "3 0 2 1", "2 0 2 1"), "face 0 has 2 corners"},
        Hostile{"space.ply", ascii_ply("comment SPACE=LAS\n"), "states SPACE=LAS; LPS and RAS are accepted"},
        Hostile{"hash.ply", ascii_ply("comment SPACE=LPS\ncomment orcart hash 0123\n"),
                "states the hash 0123"},
        Hostile{"bomb.ply", ply_header("binary_little_endian", "", "18446744073709551615"), "up to 12000000"},
        Hostile{"bomb2.ply", ply_header("binary_little_endian", "", "12000000"), "only 0 bytes follow"},
        Hostile{"bomb3.ply", ply_header("ascii", "", "4", "3999999") + "0 0 0\n1 0 0\n", "cut short"},
        Hostile{"bomb4.ply",
                replaced(ply_header("ascii"), "end_header", "element x 18446744073709551615\nend_header"),
                "bytes follow"},
        Hostile{"millions.ply", ply_header("binary_little_endian", "", "4", "4000001"), "bytes follow"},
        Hostile{"list.ply", replaced(ascii_ply(), "3 0 2 1", "1e18 0 2 1"), "face 0 has 1e+18 corners"},
        Hostile{"short.stl", "binary", "84 or more is expected"},
        Hostile{"bomb.stl", stl_of(4294967295U, 84), "up to 4000000 are accepted"},
        Hostile{"cut.stl", stl_of(2, 134), "which take 184 bytes, but it is 134"},
        Hostile{"none.stl", stl_of(0, 84), "0 triangles"}, Hostile{"cut_ascii.stl", "solid\n", "no endsolid"},
        Hostile{"vertex.stl", "solid\nvertex 1 2\nendsolid\n", "stl:2: \"vertex 1 2\""},
        Hostile{"facet.stl", "solid\nvertex 1 2 3\nendfacet\nendsolid\n", "a facet has 1 vertices"},
        Hostile{"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
                "obj:4: \"f 1 2 4\"; corners from 1 to 3"},
        Hostile{"zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "corners from 1 to 3"},
        Hostile{"before.obj", "f 1 2 3\n", "corners from 1 to 0"},
        Hostile{"text.obj", "hello\n", "0 vertices"},
        Hostile{"flat.obj", "#SPACE=LPS\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle with an area"}),
    [](const auto& hostile) {
      std::string name = hostile.param.name;
      std::replace(name.begin(), name.end(), '.', '_');
      return name;
    });

TEST(HostileSurfaces, AMissingFileSaysSo) {
  const auto surface = read_surface("/nowhere/at/all.ply");
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().message, "/nowhere/at/all.ply: cannot be read: No such file or directory");
}

TEST(HostileSurfaces, AFolderIsNoSurface) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.ply");
  EXPECT_FALSE(read_surface(folder / "a.ply"));
}

TEST(HostileSurfaces, APlyCutAnywhereIsRefused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_ply(folder / "s.ply", *make_surface(tetrahedron(), "made")));
  std::ifstream in(folder / "s.ply", std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(parse_ply(std::as_bytes(std::span(whole.data(), size)), "cut")) << size;
}

TEST(HostileSurfaces, ChangedBytesNeverCrashAnyParser) {
  std::mt19937 random(20260101);
  const std::string obj = "# SPACE=LPS\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1/1 2//1 3/1 -1\n";
  const std::string stl = stl_of(1, 134),
                    solid = "solid a\nfacet\nvertex 1 2 3\nvertex 1 2 4\nvertex 0 0 0\nendfacet\n";
  for (int round = 0; round < 3000; ++round)
    for (std::string bytes : {ascii_ply(), obj, stl, solid}) {
      for (int change = 0; change < 3; ++change) bytes[random() % bytes.size()] = static_cast<char>(random());
      const auto raw = std::as_bytes(std::span(bytes));
      for (const auto& surface : {parse_ply(raw, "x"), parse_stl(raw, "x"), parse_obj(raw, "x")})
        if (surface) (void)make_surface(surface->mesh, "x");
    }
}

}  // namespace
}  // namespace orcart
