// Painted surfaces for other programs: complete sets with names that agree, or nothing.
#include "firmware-host/files/textured_file.hpp"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

/// Two triangles of a square, and a picture of two texels: red paint, and none.
struct Painted {
  Surface surface;
  std::vector<std::array<Eigen::Vector2f, 3>> corners_uv;
  std::vector<std::uint8_t> rgba = {200, 0, 0, 255, 1, 2, 3, 0};

  Painted() {
    TriangleMesh mesh;
    mesh.vertices_mm = {{0, 0, 0.1f}, {1, 0, 0}, {1, 1.25f, 0}, {-1e-7f, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    surface = *make_surface(std::move(mesh), "square");
    surface.identity.series = "ch2.nii.gz";
    corners_uv = {{Eigen::Vector2f{0, 0}, {0.5f, 0}, {0.5f, 1}},
                  {Eigen::Vector2f{0, 0}, {0.5f, 1}, {0, 0.75f}}};
  }
  TexturedSurface textured() const {
    return {
        .surface = surface, .corners_uv = corners_uv, .width_texels = 2, .height_texels = 1, .rgba = rgba};
  }
};

std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST(TexturedFile, AnObjNamesItsMaterialAndThatItsPicture) {
  const TemporaryFolder folder;
  const auto written = write_textured(folder / "painted.obj", Painted().textured());
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(folder.count(), 3U);
  const std::string obj = text_of(folder / "painted.obj");
  EXPECT_NE(obj.find("# SPACE=LPS\n"), std::string::npos);
  EXPECT_NE(obj.find("\nmtllib painted.mtl\nv 0 0 0.1\n"), std::string::npos);
  EXPECT_NE(obj.find("\nvt 0 0.75\nusemtl painted\nf 1/1/1 2/2/2 3/3/3\nf 1/4/1 3/5/3 4/6/4\n"),
            std::string::npos);
  const std::string mtl = text_of(folder / "painted.mtl");
  EXPECT_NE(mtl.find("newmtl painted\n"), std::string::npos);
  EXPECT_NE(mtl.find("map_Kd painted.png\n"), std::string::npos);
}

TEST(TexturedFile, ThePictureIsOpaqueWithGreyForWhatHasNoPaint) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_textured(folder / "painted.obj", Painted().textured()));
  const auto picture = read_picture(folder / "painted.png");
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->rgba, (std::vector<std::uint8_t>{200, 0, 0, 255, 150, 150, 150, 255}));
}

TEST(TexturedFile, ItsSurfaceIsReadBackWithItsIdentity) {
  const TemporaryFolder folder;
  const Painted painted;
  for (const char* name : {"painted.obj", "painted.ply"}) {
    ASSERT_TRUE(write_textured(folder / name, painted.textured()));
    const auto back = read_surface(folder / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->mesh.triangles, painted.surface.mesh.triangles);
    EXPECT_EQ(back->identity.hash, painted.surface.identity.hash) << name;
    EXPECT_EQ(back->identity.series, "ch2.nii.gz");
  }
}

TEST(TexturedFile, APlyHoldsAPlaceForEachVertex) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_textured(folder / "painted.ply", Painted().textured()));
  EXPECT_EQ(folder.count(), 2U);
  const std::string ply = text_of(folder / "painted.ply");
  EXPECT_NE(ply.find("comment TextureFile painted.png\n"), std::string::npos);
  const std::size_t vertices = ply.find("end_header\n") + 11, vertex = 32, face = 1 + 12;
  ASSERT_EQ(ply.size(), vertices + 4 * vertex + 2 * face);
  std::array<float, 2> third{};
  std::memcpy(third.data(), ply.data() + vertices + 2 * vertex + 24, 8);
  EXPECT_EQ(third, (std::array<float, 2>{0.5F, 1}));
}

TEST(TexturedFile, APlyRepeatsTheVerticesOfASeamAndIsReadBackWithoutIt) {
  const TemporaryFolder folder;
  Painted painted;
  painted.corners_uv[1] = {
      Eigen::Vector2f{0.5F, 0.5F}, {0.5F, 1}, {0, 0.75F}};  // the first corner has two places
  ASSERT_TRUE(write_textured(folder / "painted.ply", painted.textured()));
  EXPECT_NE(text_of(folder / "painted.ply").find("element vertex 5\n"), std::string::npos);
  const auto back = read_surface(folder / "painted.ply");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->mesh.triangles, painted.surface.mesh.triangles);
  EXPECT_EQ(back->identity.hash, painted.surface.identity.hash);
}

TEST(TexturedFile, VerticesThatStandTogetherAndMinusZeroAreReadBackAsTheyWere) {
  const TemporaryFolder folder;
  TriangleMesh mesh;  // two triangles that touch in a point, of which each has a vertex, with two places each
  mesh.vertices_mm = {{-0.0F, 0, 0}, {1, 0, 0},   {1, 1, -0.0F}, {0, 0, 0},
                      {-1, 0, 0},    {-1, -1, 0}, {0, 1, 0},     {0, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {0, 2, 6}, {3, 5, 7}};
  const Surface surface = *make_surface(std::move(mesh), "touching");
  std::vector<std::array<Eigen::Vector2f, 3>> places;
  for (int t = 0; t < 4; ++t) {
    const float at = 0.2F * static_cast<float>(t);
    places.push_back({Eigen::Vector2f{at, 0}, {at + 0.1F, 0}, {at + 0.1F, 0.5F}});
  }
  const std::vector<std::uint8_t> rgba(8, 255);
  ASSERT_TRUE(write_textured(
      folder / "painted.ply",
      {.surface = surface, .corners_uv = places, .width_texels = 2, .height_texels = 1, .rgba = rgba}));
  const auto back = read_surface(folder / "painted.ply");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->mesh.triangles, surface.mesh.triangles);
  EXPECT_EQ(back->identity.hash, surface.identity.hash);
}

TEST(TexturedFile, ASeamThatNamesNoVertexIsRefused) {
  const TemporaryFolder folder;
  Painted painted;
  painted.corners_uv[1][0] = {0.5F, 0.5F};
  ASSERT_TRUE(write_textured(folder / "painted.ply", painted.textured()));
  std::string ply = text_of(folder / "painted.ply");
  ply[ply.size() - 4] = 4;  // the repeated vertex itself
  EXPECT_FALSE(read_surface(folder.write("changed.ply", ply)));
  for (std::size_t cut = 1; cut <= 4; ++cut)
    EXPECT_FALSE(read_surface(folder.write("cut.ply", ply.substr(0, ply.size() - cut)))) << cut;
}

TEST(TexturedFile, LeavesNothingWhereItFails) {
  const TemporaryFolder folder;
  Painted painted;
  std::filesystem::create_directory(folder / "painted.mtl");
  const auto taken = write_textured(folder / "painted.obj", painted.textured());
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().message.find("painted.mtl: is a folder"), std::string::npos)
      << taken.error().message;
  painted.rgba.pop_back();
  const auto cut_short = write_textured(folder / "other.ply", painted.textured());
  ASSERT_FALSE(cut_short);
  EXPECT_NE(cut_short.error().message.find("its picture has 7 bytes, 8 are needed"), std::string::npos)
      << cut_short.error().message;
  painted.corners_uv.pop_back();
  EXPECT_FALSE(write_textured(folder / "other.ply", painted.textured()));
  EXPECT_FALSE(write_textured(folder / "no/such/folder.ply", Painted().textured()));
  EXPECT_EQ(folder.count(), 1U);
}

TEST(TexturedFile, ALinkStaysOneAndAPipeIsRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "far");
  std::filesystem::create_symlink("far/p.png", folder / "painted.png");
  ASSERT_TRUE(write_textured(folder / "painted.ply", Painted().textured()));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "painted.png"));
  EXPECT_TRUE(read_picture(folder / "far/p.png"));
  ASSERT_EQ(::mkfifo((folder / "pipe.png").c_str(), 0600), 0);
  EXPECT_FALSE(write_textured(folder / "pipe.ply", Painted().textured()));
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pipe.ply"));
}

TEST(TexturedFile, RefusesOtherFormats) {
  const auto written = write_textured("/tmp/painted.stl", Painted().textured());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "/tmp/painted.stl: a painted surface is written as .obj, .ply or .glb");
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

TEST(TexturedFile, AGlbHoldsAllInTwoChunksOfWholeWords) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_textured(folder / "painted.glb", Painted().textured()));
  EXPECT_EQ(folder.count(), 1U);
  const std::string glb = text_of(folder / "painted.glb");
  ASSERT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(glb, 4), 2U);
  EXPECT_EQ(word_at(glb, 8), glb.size());
  const std::uint32_t json = word_at(glb, 12);
  EXPECT_EQ(json % 4, 0U);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  const std::uint32_t binary = word_at(glb, 20 + json);
  EXPECT_EQ(20 + json + 8 + binary, glb.size());
  EXPECT_EQ(binary % 4, 0U);
  EXPECT_EQ(glb.substr(24 + json, 4), std::string("BIN\0", 4));
  // Two vertices have one place in the picture, two have one each in both triangles: (0,0) and (0.5,1) twice,
  // the same.
  const std::string text = glb.substr(20, json);
  EXPECT_NE(text.find(R"("count":4,"type":"VEC3","min":)"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("count":6,"type":"SCALAR")"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("series":"ch2.nii.gz")"), std::string::npos) << text;
  std::array<float, 2> third_place{};
  std::memcpy(third_place.data(), glb.data() + 28 + json + 4 * 12 + 4 * 12 + 2 * 8, 8);
  EXPECT_EQ(third_place, (std::array<float, 2>{0.5F, 0})) << "glTF counts from the picture's top";
}

}  // namespace
}  // namespace orcart
