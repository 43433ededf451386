// From a region to its surface: cut, smoothed and thinned out.
#pragma once

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "tools/surface/soft_mask.hpp"

namespace orcart {

struct Extraction {
  int triangles = 50'000;  ///< at most so many; the surface stays closed
  int smoothing_iterations =
      20;                  ///< of the windowed sinc (Taubin, Zhang and Golub 1996), which hardly shrinks
  double pass_band = 0.1;  ///< 0..2; less is smoother
};

/// Flying edges (Schroeder, Maynard and Geveci 2015) at 0.5, the largest piece, windowed-sinc smoothing,
/// quadric decimation (Garland and Heckbert 1997). LPS mm; triangles counter-clockwise seen from outside.
Result<TriangleMesh> extract_surface(const SoftMask& mask, const Extraction& options);

}  // namespace orcart
