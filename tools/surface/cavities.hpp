// Counts the voxels of a region and fills the cavities it encloses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace orcart {

/// A mask somebody else owns: voxels[i + size[0] * (j + size[1] * k)], 0 outside.
struct VoxelGrid {
  std::array<int, 3> size{};
  std::span<std::uint8_t> voxels;
};

struct VoxelCount {
  std::size_t voxels = 0;
  std::array<int, 3> first{}, last{};  ///< the smallest box that holds them, both ends included
  bool touches_border = false;
};
VoxelCount count_voxels(const VoxelGrid& grid);

/// Fills what cannot be reached from the border through faces of outside voxels; says how many it filled.
std::size_t fill_cavities(const VoxelGrid& grid);

}  // namespace orcart
