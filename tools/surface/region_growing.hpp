// Grows a region in a CT or MR volume from seeds, as the first step towards its surface.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "realtime/base/result.hpp"
#include "tools/surface/soft_mask.hpp"

namespace orcart {

struct RegionGrowing {
  std::filesystem::path volume;      ///< .nii, .nii.gz, .nrrd or .mha
  std::vector<PlainPoint> seeds_mm;  ///< LPS
  double lowest = 0, highest = 0;    ///< intensities that belong to the region, both included
  double denoise_mm = 0;             ///< standard deviation of a Gaussian over the volume before growing
  double close_mm = 0;               ///< dents, gaps and handles narrower than twice this are filled
  double smooth_mm = 0.7;            ///< standard deviation of the Gaussian over the region
  double grid_mm = 0;                ///< spacing to cut the surface from; 0: the volume's own
  double largest_ml = 200;           ///< a larger region is refused as a leak
};

struct GrownRegion {
  SoftMask mask;
  double volume_ml = 0;  ///< of the voxels, gaps and cavities filled
  std::size_t voxels = 0;
  std::size_t filled_voxels = 0;  ///< of which gaps and cavities that were filled
};

/// The voxels connected to the seeds through faces whose intensity is within the range; cavities closed;
/// smoothed. Refuses a seed outside the volume or the range, and a region that leaks.
Result<GrownRegion> grow_region(const RegionGrowing& options);

}  // namespace orcart
