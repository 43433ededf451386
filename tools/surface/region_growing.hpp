// Grows a region in a CT or MR volume from seeds, as the first step towards its surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "tools/surface/cavities.hpp"
#include "tools/volume/volume.hpp"

namespace orcart {

/// What to do with a region whose volume jumps while its range widens.
enum class LeakPolicy { refuse, accept };

struct RegionGrowing {
  std::vector<PlainPoint> seeds_mm;  ///< LPS
  double lowest = 0, highest = 0;    ///< intensities that belong to the region, both included
  double largest_ml = 0;             ///< a larger region is refused as a leak; 0: no limit
  LeakPolicy leak = LeakPolicy::refuse;
};

/// How the region grows while the range widens from the seeds' own intensities to the whole range.
struct GrowthCurve {
  static constexpr int kSteps = 64;
  std::vector<double> volume_ml;  ///< kSteps + 1 numbers: with step/kSteps of the range on either side
  int jump_at = 0;                ///< the step of the worst jump among those that look like a leak; 0: none
};

/// The steps at which a volume of at least 0.5 ml doubles at once, in the outer three quarters of the range.
/// Nearer to the seeds' intensities a jump is the region itself coming together out of the noise.
int leak_step(const std::vector<double>& volume_ml);

struct GrownRegion {
  std::vector<std::uint8_t> voxels;  ///< 1 inside, of the whole volume
  VoxelCount count;
  double volume_ml = 0;
  GrowthCurve curve;
  std::vector<std::string> notes;  ///< sentences, e.g. that it reaches the border
};

/// The voxels connected to the seeds through faces whose intensity is within the range, in one pass that
/// widens the range step by step. Refuses a seed outside the volume or the range, and a leak (a jump of the
/// volume, or more than largest_ml). `name` is for messages.
Result<GrownRegion> grow_region(const Volume& volume, const RegionGrowing& options, const std::string& name);

}  // namespace orcart
