// Flood fill from the border: what it does not reach is a cavity.
#include "tools/surface/cavities.hpp"

#include <algorithm>
#include <vector>

namespace orcart {

namespace {

template <class Visit>
void for_each_voxel(const VoxelGrid& grid, Visit visit) {
  std::size_t at = 0;
  std::array<int, 3> index{};
  for (index[2] = 0; index[2] < grid.size[2]; ++index[2])
    for (index[1] = 0; index[1] < grid.size[1]; ++index[1])
      for (index[0] = 0; index[0] < grid.size[0]; ++index[0]) visit(at++, index);
}

bool on_border(const VoxelGrid& grid, const std::array<int, 3>& index) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (index[axis] == 0 || index[axis] == grid.size[axis] - 1) return true;
  return false;
}

}  // namespace

VoxelCount count_voxels(const VoxelGrid& grid) {
  VoxelCount count{.voxels = 0, .first = grid.size, .last = {-1, -1, -1}, .touches_border = false};
  for_each_voxel(grid, [&](std::size_t at, const std::array<int, 3>& index) {
    if (grid.voxels[at] == 0) return;
    ++count.voxels;
    count.touches_border = count.touches_border || on_border(grid, index);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count.first[axis] = std::min(count.first[axis], index[axis]);
      count.last[axis] = std::max(count.last[axis], index[axis]);
    }
  });
  return count;
}

std::size_t fill_cavities(const VoxelGrid& grid) {
  constexpr std::uint8_t kReached = 255;
  std::vector<std::size_t> reached;
  const auto reach = [&](std::size_t at) {
    if (grid.voxels[at] != 0) return;
    grid.voxels[at] = kReached;
    reached.push_back(at);
  };
  for_each_voxel(grid, [&](std::size_t at, const std::array<int, 3>& index) {
    if (on_border(grid, index)) reach(at);
  });
  const auto nx = static_cast<std::size_t>(grid.size[0]), layer = nx * static_cast<std::size_t>(grid.size[1]);
  const std::array<std::size_t, 3> stride{1, nx, layer};
  while (!reached.empty()) {
    const std::size_t at = reached.back();
    reached.pop_back();
    const std::array<int, 3> index{static_cast<int>(at % nx), static_cast<int>(at % layer / nx),
                                   static_cast<int>(at / layer)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (index[axis] > 0) reach(at - stride[axis]);
      if (index[axis] + 1 < grid.size[axis]) reach(at + stride[axis]);
    }
  }
  std::size_t filled = 0;
  for (std::uint8_t& voxel : grid.voxels) {
    filled += voxel == 0 ? 1 : 0;
    voxel = voxel == kReached ? 0 : 1;
  }
  return filled;
}

}  // namespace orcart
