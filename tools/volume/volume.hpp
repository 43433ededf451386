// A CT or MR volume in memory, with the patient space it lies in and what its file says of itself.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace orcart {

/// Three coordinates in LPS, millimetres. Plain, since ITK brings an Eigen of its own that clashes with ours.
using PlainPoint = std::array<double, 3>;

/// Where a grid of voxels lies: the centre of voxel (i, j, k) is origin_mm + i step_mm[0] + j step_mm[1] +
/// k step_mm[2], LPS. The steps need not be at right angles (a tilted gantry).
struct VoxelLattice {
  std::array<int, 3> size{};
  PlainPoint origin_mm{};
  std::array<PlainPoint, 3> step_mm{};

  std::size_t voxels() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
};

PlainPoint place_of(const VoxelLattice& lattice, const std::array<double, 3>& index);
/// The inverse of place_of; the steps are independent in every volume that read_volume gives.
std::array<double, 3> index_at(const VoxelLattice& lattice, const PlainPoint& place_mm);
double step_length_mm(const VoxelLattice& lattice, int axis);
/// Positive: the axes are right-handed.
double voxel_mm3(const VoxelLattice& lattice);

struct Volume {
  VoxelLattice lattice;
  std::vector<float> values;       ///< values[i + size[0] * (j + size[1] * k)]; Hounsfield where CT says so
  std::string kind;                ///< e.g. "DICOM CT, 300 slices"
  std::string series;              ///< DICOM series UID, or the file's name
  std::string frame_of_reference;  ///< DICOM UID; empty where the file says nothing
  std::vector<std::string> notes;  ///< what was mended or noticed; each is one sentence
};

}  // namespace orcart
