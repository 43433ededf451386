// From the voxels of a region to a smooth field that a surface can be cut from.
#pragma once

#include <string>

#include "realtime/base/result.hpp"
#include "tools/surface/region_growing.hpp"
#include "tools/surface/soft_mask.hpp"

namespace orcart {

struct SoftRegion {
  double close_mm = 0;     ///< dents, gaps and handles narrower than twice this are filled
  double smooth_mm = 0.7;  ///< standard deviation of the Gaussian over the region
  double grid_mm = 0;      ///< spacing to cut the surface from; 0: the volume's own
};

struct SoftenedRegion {
  SoftMask mask;
  double volume_ml = 0;           ///< of the voxels, gaps and cavities filled
  std::size_t filled_voxels = 0;  ///< of which gaps and cavities that were filled
};

/// Smooths the volume itself, before growing: a Gaussian of `sigma_mm`. 0 leaves it alone.
Result<void> denoise(Volume& volume, double sigma_mm, const std::string& name);

/// Closes by a ball, fills cavities, resamples and smooths the region; works on its part of the volume alone.
/// Takes the region's voxels. `name` is for messages.
Result<SoftenedRegion> soften(GrownRegion region, const VoxelLattice& lattice, const SoftRegion& options,
                              const std::string& name);

}  // namespace orcart
