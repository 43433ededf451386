// The charts that the cart will paint a surface in, for programs that bring pictures of their own.
#pragma once

#include <filesystem>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

struct ChartOutput {
  std::filesystem::path file;  ///< .obj, .ply or .glb (textured_file.hpp); empty: none
  double texel_mm = 0.2;
};

struct ChartReport {
  std::filesystem::path file;
  std::size_t charts = 0;
  int size_texels = 0;    ///< of a side
  double texel_mm = 0;    ///< what was reached
  double used_share = 0;  ///< of the picture, by texels whose centre lies in a triangle
};

/// The surface with a place in the picture for each corner of its triangles, and each chart in a colour of
/// its own. The charts are those of build_atlas(): the same surface and texel size give the same, in the cart
/// too. Writes nothing where it fails.
Result<ChartReport> write_charts(const Surface& surface, const ChartOutput& output);

}  // namespace orcart
