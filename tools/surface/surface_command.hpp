// What `orcart surface` does with a volume: a closed surface and its report.
#pragma once

#include "tools/mesh/import_command.hpp"
#include "tools/surface/extraction.hpp"
#include "tools/surface/region_growing.hpp"
#include "tools/surface/soft_region.hpp"
#include "tools/volume/volume_reader.hpp"

namespace orcart {

struct SurfaceCommand {
  VolumeRequest volume;
  double denoise_mm = 0;  ///< standard deviation of a Gaussian over the volume before growing
  RegionGrowing region;
  SoftRegion soft;
  Extraction extraction;
  SurfaceOutput output;
};

/// Writes nothing unless the surface came out closed.
Result<SurfaceReport> make_surface_file(const SurfaceCommand& command, const SurfaceProgress& progress);

}  // namespace orcart
