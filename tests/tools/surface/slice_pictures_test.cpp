// Slices lie as a person expects, and the outline lies where the surface is.
#include "tools/surface/slice_pictures.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace orcart {
namespace {

/// 40x40x20 voxels of 1 x 1 x 2 mm; bright where x is towards the patient's left.
Volume left_bright() {
  Volume volume;
  volume.lattice = {.size = {40, 40, 20},
                    .origin_mm = {0, 0, 0},
                    .step_mm = {PlainPoint{1, 0, 0}, PlainPoint{0, 1, 0}, PlainPoint{0, 0, 2}}};
  for (std::size_t i = 0; i < volume.lattice.voxels(); ++i)
    volume.values.push_back(i % 40 >= 30 ? 100.0F : 0.0F);
  return volume;
}

/// A tetrahedron about (20, 20, 20) mm.
TriangleMesh tetrahedron() {
  return {.vertices_mm = {{10, 10, 10}, {30, 10, 10}, {20, 30, 10}, {20, 20, 35}},
          .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

bool yellow(const Picture& picture, int x, int y) {
  const std::uint8_t* p =
      picture.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width_px) +
                                 static_cast<std::size_t>(x));
  return p[0] == 255 && p[1] == 205 && p[2] == 0;
}

TEST(SlicePictures, PixelsAreSquareWhereVoxelsAreNot) {
  const auto slices = draw_slices(left_bright(), tetrahedron(), {20, 20, 20});
  EXPECT_EQ(slices[2].across, 'z');
  EXPECT_EQ(slices[2].picture.width_px, slices[2].picture.height_px);  // 40 x 40 mm
  EXPECT_EQ(slices[0].picture.width_px, slices[0].picture.height_px);  // 40 x 40 mm of 40 x 20 voxels
}

TEST(SlicePictures, ThePatientsLeftIsAtTheRightOfAnAxialSlice) {
  for (const double direction : {1.0, -1.0}) {
    Volume volume = left_bright();
    if (direction < 0) {  // the same anatomy, stored from left to right
      volume.lattice.step_mm[0][0] = -1;
      volume.lattice.origin_mm[0] = 39;
      for (std::size_t row = 0; row < volume.values.size(); row += 40)
        std::reverse(volume.values.begin() + static_cast<std::ptrdiff_t>(row),
                     volume.values.begin() + static_cast<std::ptrdiff_t>(row + 40));
    }
    const Picture picture = draw_slices(volume, tetrahedron(), {20, 20, 20})[2].picture;
    const std::size_t row = static_cast<std::size_t>(picture.width_px) * 4 * 20;
    EXPECT_EQ(picture.rgba[row + 4 * 20], 0);
    EXPECT_EQ(picture.rgba[row + 4 * static_cast<std::size_t>(picture.width_px - 20)], 255);
  }
}

TEST(SlicePictures, TheOutlineLiesOnTheSurface) {
  // At z = 20 mm the edge from (10, 10, 10) to (20, 20, 35) is at (14, 14): pixel (14.5 / 40) 512.
  const Picture picture = draw_slices(left_bright(), tetrahedron(), {20, 20, 20})[2].picture;
  bool found = false;
  for (int y = 183; y <= 188; ++y)
    for (int x = 183; x <= 188; ++x) found = found || yellow(picture, x, y);
  EXPECT_TRUE(found);
  EXPECT_FALSE(yellow(picture, 256, 256));
}

}  // namespace
}  // namespace orcart
