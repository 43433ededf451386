// From a region to its surface: cut, smoothed and thinned out.
#pragma once

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "tools/mesh/mesh_distance.hpp"
#include "tools/surface/soft_mask.hpp"

namespace orcart {

/// Which pieces of the cut surface are kept: the largest, all, or the n-th by size (from 1).
struct PieceChoice {
  enum class Kind { largest, all, numbered } kind = Kind::largest;
  int number = 1;
};

struct Extraction {
  int triangles = 50'000;  ///< at most so many; the surface stays closed
  int smoothing_iterations =
      20;                  ///< of the windowed sinc (Taubin, Zhang and Golub 1996), which hardly shrinks
  double pass_band = 0.1;  ///< 0..2; less is smoother
  PieceChoice pieces;
};

struct ExtractedSurface {
  TriangleMesh mesh;
  std::size_t cut_triangles = 0;  ///< before thinning out
  double smoothing_max_mm = 0;    ///< how far the windowed sinc moved a vertex at most
  MeshDistance thinning;          ///< of the vertices before thinning out to the surface after it
};

/// Flying edges (Schroeder, Maynard and Geveci 2015) at 0.5, the pieces chosen, windowed-sinc smoothing,
/// quadric decimation (Garland and Heckbert 1997). LPS mm; triangles counter-clockwise seen from outside.
Result<ExtractedSurface> extract_surface(const SoftMask& mask, const Extraction& options);

}  // namespace orcart
