// The affine arithmetic of a grid of voxels.
#include "tools/volume/volume.hpp"

#include <cmath>

namespace orcart {

namespace {

PlainPoint cross(const PlainPoint& a, const PlainPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const PlainPoint& a, const PlainPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

PlainPoint place_of(const VoxelLattice& lattice, const std::array<double, 3>& index) {
  PlainPoint place = lattice.origin_mm;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t row = 0; row < 3; ++row) place[row] += index[axis] * lattice.step_mm[axis][row];
  return place;
}

std::array<double, 3> index_at(const VoxelLattice& lattice, const PlainPoint& place_mm) {
  const auto& [a, b, c] = lattice.step_mm;
  PlainPoint offset;
  for (std::size_t row = 0; row < 3; ++row) offset[row] = place_mm[row] - lattice.origin_mm[row];
  const double volume = dot(a, cross(b, c));
  return {dot(offset, cross(b, c)) / volume, dot(offset, cross(c, a)) / volume,
          dot(offset, cross(a, b)) / volume};
}

double step_length_mm(const VoxelLattice& lattice, int axis) {
  const PlainPoint& step = lattice.step_mm[static_cast<std::size_t>(axis)];
  return std::sqrt(dot(step, step));
}

double voxel_mm3(const VoxelLattice& lattice) {
  return dot(lattice.step_mm[0], cross(lattice.step_mm[1], lattice.step_mm[2]));
}

}  // namespace orcart
