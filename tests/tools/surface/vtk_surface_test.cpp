// VTK's formats come in, and what 3D Slicer says of their space is obeyed.
#include "tools/surface/vtk_surface.hpp"

#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

std::string tetrahedron_vtk(const std::string& title) {
  return "# vtk DataFile Version 3.0\n" + title +
         "\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 10 0 0 0 10 0 0 0 10\n"
         "POLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
}

std::string tetrahedron_vtp(const std::string& field) {
  return "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>" + field +
         "<Piece NumberOfPoints=\"4\" NumberOfPolys=\"4\"><Points><DataArray type=\"Float32\" "
         "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 10 0 0 0 10 0 0 0 10</DataArray></Points><Polys>"
         "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 2 1 0 1 3 1 2 3 2 0 "
         "3</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 6 9 "
         "12</DataArray></Polys>"
         "</Piece></PolyData></VTKFile>\n";
}

TEST(VtkSurface, ObeysTheSpaceInSlicersHeaderLine) {
  const TemporaryFolder folder;
  const auto lps = read_vtk_surface(folder.write("a.vtk", tetrahedron_vtk("3D Slicer output. SPACE=LPS")),
                                    nullptr, std::nullopt);
  const auto ras = read_vtk_surface(folder.write("b.vtk", tetrahedron_vtk("3D Slicer output. SPACE=RAS")),
                                    nullptr, std::nullopt);
  ASSERT_TRUE(lps) << lps.error().message;
  ASSERT_TRUE(ras) << ras.error().message;
  EXPECT_TRUE(lps->closed);
  EXPECT_EQ(lps->mesh.vertices_mm[1].x(), 10);
  EXPECT_EQ(ras->mesh.vertices_mm[1].x(), -10);
}

TEST(VtkSurface, ObeysTheFieldInAVtp) {
  const TemporaryFolder folder;
  const std::string field =
      "<FieldData><Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">82 65 83 "
      "0</Array></FieldData>";  // "RAS"
  const auto ras = read_vtk_surface(folder.write("a.vtp", tetrahedron_vtp(field)), nullptr, std::nullopt);
  ASSERT_TRUE(ras) << ras.error().message;
  EXPECT_EQ(ras->mesh.vertices_mm[1].x(), -10);
}

TEST(VtkSurface, OneThatStatesNoSpaceIsRefusedUntilTold) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.vtk", tetrahedron_vtk("made by hand"));
  const auto refused = read_vtk_surface(file, nullptr, std::nullopt);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("no coordinate system"), std::string::npos);
  EXPECT_TRUE(read_vtk_surface(file, nullptr, Space::lps));
}

TEST(VtkSurface, OneThatIsCutShortIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = tetrahedron_vtk("3D Slicer output. SPACE=LPS");
  for (const std::size_t missing : {4, 9, 20, 45, 70}) {
    const auto surface = read_vtk_surface(folder.write("a.vtk", whole.substr(0, whole.size() - missing)),
                                          nullptr, std::nullopt);
    EXPECT_FALSE(surface) << missing;
  }
}

/// Binary, with what 3D Slicer's field says of the space before the points, and an array of numbers.
std::string sphere_with_field(const std::string& version, const std::string& metadata) {
  constexpr std::uint32_t kRings = 24, kSides = 24;
  std::string text = "# vtk DataFile Version " + version +
                     "\nx\nBINARY\nDATASET POLYDATA\nFIELD FieldData 2\nSPACE 1 1 string\n\xc3LPS\n" +
                     metadata + "numbers 2 3 short\n" + std::string(12, '\n') + "\n" + metadata + "POINTS " +
                     std::to_string((kRings + 1) * kSides) + " float\n";
  const auto put = [&](std::uint32_t word) {
    for (const unsigned shift : {24U, 16U, 8U, 0U}) text += static_cast<char>(word >> shift & 0xFFU);
  };
  for (std::uint32_t r = 0; r <= kRings; ++r)
    for (std::uint32_t s = 0; s < kSides; ++s) {
      const double down = std::numbers::pi * r / kRings, around = 2 * std::numbers::pi * s / kSides;
      for (const double place : {10 * std::sin(down) * std::cos(around),
                                 10 * std::sin(down) * std::sin(around), 10 * std::cos(down)})
        put(std::bit_cast<std::uint32_t>(static_cast<float>(place)));
    }
  text += "\nPOLYGONS " + std::to_string(kRings * kSides) + " " + std::to_string(5 * kRings * kSides) + "\n";
  for (std::uint32_t r = 0; r < kRings; ++r)
    for (std::uint32_t s = 0; s < kSides; ++s) {
      const std::uint32_t next = (s + 1) % kSides;
      for (const std::uint32_t word :
           {4U, r * kSides + s, (r + 1) * kSides + s, (r + 1) * kSides + next, r * kSides + next})
        put(word);
    }
  return text + "\n";
}

TEST(VtkSurface, OneWithAFieldIsReadWholeAndRefusedCutShort) {
  const TemporaryFolder folder;
  for (const std::string metadata : {"", "METADATA\nINFORMATION 0\n\n"}) {
    const std::string whole = sphere_with_field("3.0", metadata);
    const auto surface = read_vtk_surface(folder.write("a.vtk", whole), nullptr, std::nullopt);
    ASSERT_TRUE(surface) << surface.error().message;
    EXPECT_NEAR(surface->mesh.vertices_mm[0].z(), 10, 1e-6);
    for (std::size_t size = 0; size + 1 < whole.size(); size += size < 300 ? 1 : 97)
      EXPECT_FALSE(read_vtk_surface(folder.write("a.vtk", whole.substr(0, size)), nullptr, Space::lps))
          << size;
  }
}

TEST(VtkSurface, KeywordsInSmallLettersAreKnown) {
  const TemporaryFolder folder;
  std::string text = tetrahedron_vtk("SPACE=LPS");
  for (const char* word : {"DATASET", "POINTS", "POLYGONS"})
    for (std::size_t i = text.find(word), end = i + std::strlen(word); i < end; ++i)
      text[i] = static_cast<char>(std::tolower(text[i]));
  EXPECT_TRUE(read_vtk_surface(folder.write("a.vtk", text), nullptr, std::nullopt));
  EXPECT_FALSE(
      read_vtk_surface(folder.write("a.vtk", text.substr(0, text.size() - 9)), nullptr, std::nullopt));
}

TEST(VtkSurface, GarbageAndPicturesAreRefused) {
  const TemporaryFolder folder;
  for (const char* name : {"a.vtk", "a.vtp"})
    for (const char* text :
         {"", "hello", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n"}) {
      const auto refused = read_vtk_surface(folder.write(name, text), nullptr, Space::lps);
      ASSERT_FALSE(refused) << name << text;
      EXPECT_NE(refused.error().message.find("a.vt"), std::string::npos);
    }
}

}  // namespace
}  // namespace orcart
