// mz3 comes in plain and gzipped; what is damaged is refused.
#include <zlib.h>

#include <cstring>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

/// A tetrahedron; `corner` replaces the last index.
std::string tetrahedron(std::uint32_t corner = 3) {
  const std::uint32_t faces[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, corner};
  const float vertices[] = {0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10};
  const std::uint32_t counts[] = {4, 4, 8};
  std::string bytes = "MZ";
  bytes += std::string("\x03\x00", 2);
  bytes.append(reinterpret_cast<const char*>(counts), sizeof counts);
  bytes += "comments";
  bytes.append(reinterpret_cast<const char*>(faces), sizeof faces);
  bytes.append(reinterpret_cast<const char*>(vertices), sizeof vertices);
  return bytes;
}

std::filesystem::path gzipped(const TemporaryFolder& folder, const std::string& bytes) {
  const auto file = folder / "zipped.mz3";
  const gzFile out = gzopen(file.c_str(), "wb");
  gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(out);
  return file;
}

void expect_refused(const std::filesystem::path& file, const std::string& why) {
  const auto surface = read_surface(file, nullptr, Space::ras);
  ASSERT_FALSE(surface);
  EXPECT_NE(surface.error().message.find(why), std::string::npos) << surface.error().message;
}

TEST(SurfaceMz3, IsReadPlainAndGzipped) {
  const TemporaryFolder folder;
  for (const auto& file : {folder.write("plain.mz3", tetrahedron()), gzipped(folder, tetrahedron())}) {
    const auto surface = read_surface(file, nullptr, Space::ras);
    ASSERT_TRUE(surface) << surface.error().message;
    EXPECT_TRUE(surface->closed);
    EXPECT_EQ(surface->mesh.triangles.size(), 4U);
    EXPECT_EQ(surface->mesh.vertices_mm[1].x(), -10);
  }
}

TEST(SurfaceMz3, StatesNoSpaceAndIsRefusedUntilTold) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_surface(folder.write("plain.mz3", tetrahedron())));
}

TEST(SurfaceMz3, CutAtEveryByteIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = tetrahedron();
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(read_surface(folder.write("cut.mz3", whole.substr(0, length)), nullptr, Space::ras));
}

TEST(SurfaceMz3, AnIndexOutOfRangeAndTooManyAreRefused) {
  const TemporaryFolder folder;
  expect_refused(folder.write("wrong.mz3", tetrahedron(4)), "triangle 3 has vertex 4");
  std::string many = tetrahedron();
  many[7] = '\x7F';
  expect_refused(folder.write("many.mz3", many), "up to 4000000");
  expect_refused(folder.write("text.mz3", "this is no mesh at all"), "does not begin as an mz3");
}

}  // namespace
}  // namespace orcart
