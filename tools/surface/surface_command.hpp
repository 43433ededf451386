// What `orcart surface` does: a volume in, a closed surface and its figures out.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "realtime/base/result.hpp"
#include "tools/surface/extraction.hpp"
#include "tools/surface/region_growing.hpp"

namespace orcart {

struct SurfaceCommand {
  RegionGrowing region;
  Extraction extraction;
  std::filesystem::path out;
};

struct SurfaceFigures {
  double region_ml = 0;  ///< of the voxels
  std::size_t filled_voxels = 0;
  double volume_ml = 0;  ///< enclosed by the triangles
  double area_mm2 = 0;
  long euler_number = 0;  ///< vertices - edges + triangles; 2 for a ball, 2 less for each handle
  bool closed = false;
  std::size_t vertices = 0, triangles = 0;
  std::string hash;
};

/// Told before each step: its number from 1, how many there are, and what it is.
using SurfaceProgress = std::function<void(int step, int steps, const std::string& what)>;

/// Writes nothing unless the surface came out closed.
Result<SurfaceFigures> make_surface_file(const SurfaceCommand& command, const SurfaceProgress& progress);

}  // namespace orcart
