// A region of a volume as a smooth field: 1 inside, 0 outside, its surface at 0.5.
#pragma once

#include <vector>

#include "tools/volume/volume.hpp"

namespace orcart {

/// values[i + size[0] * (j + size[1] * k)] lie on the lattice. The outermost layer is 0, so that a surface of
/// it is closed.
struct SoftMask {
  VoxelLattice lattice;
  std::vector<float> values;
};

}  // namespace orcart
