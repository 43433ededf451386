// Cavities are filled, bays are not, and a region at the border is noticed.
#include "tools/surface/cavities.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace orcart {
namespace {

/// A 5x5x5 mask whose 3x3x3 middle is a shell around one empty voxel.
std::vector<std::uint8_t> shell() {
  std::vector<std::uint8_t> voxels(125);
  for (std::size_t k = 1; k < 4; ++k)
    for (std::size_t j = 1; j < 4; ++j)
      for (std::size_t i = 1; i < 4; ++i) voxels[i + 5 * (j + 5 * k)] = 1;
  voxels[2 + 5 * (2 + 5 * 2)] = 0;
  return voxels;
}

TEST(Cavities, AnEnclosedVoxelIsFilled) {
  auto voxels = shell();
  const VoxelGrid grid{.size = {5, 5, 5}, .voxels = voxels};
  EXPECT_EQ(count_voxels(grid).voxels, 26U);
  EXPECT_EQ(fill_cavities(grid), 1U);
  EXPECT_EQ(count_voxels(grid).voxels, 27U);
}

TEST(Cavities, ABayThatOpensToTheOutsideIsLeft) {
  auto voxels = shell();
  voxels[2 + 5 * (2 + 5 * 1)] = 0;
  const VoxelGrid grid{.size = {5, 5, 5}, .voxels = voxels};
  EXPECT_EQ(fill_cavities(grid), 0U);
  EXPECT_EQ(count_voxels(grid).voxels, 25U);
}

TEST(Cavities, TheBoxHoldsTheRegionAndTheBorderIsNoticed) {
  auto voxels = shell();
  const VoxelGrid grid{.size = {5, 5, 5}, .voxels = voxels};
  EXPECT_EQ(count_voxels(grid).first, (std::array{1, 1, 1}));
  EXPECT_EQ(count_voxels(grid).last, (std::array{3, 3, 3}));
  EXPECT_FALSE(count_voxels(grid).touches_border);
  voxels[2 + 5 * (2 + 5 * 4)] = 1;
  EXPECT_TRUE(count_voxels(grid).touches_border);
}

TEST(Cavities, AnEmptyMaskStaysEmpty) {
  std::vector<std::uint8_t> voxels(27);
  const VoxelGrid grid{.size = {3, 3, 3}, .voxels = voxels};
  EXPECT_EQ(fill_cavities(grid), 0U);
  EXPECT_EQ(count_voxels(grid).voxels, 0U);
}

}  // namespace
}  // namespace orcart
