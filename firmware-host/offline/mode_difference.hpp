// How far apart the two modes put the same light: what paper mode costs on a surface that is not of one
// depth.
#pragma once

#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "render/atlas/atlas_layout.hpp"

namespace orcart {

/// The displacement of the paint at each texel: from the point that stands there to the one whose light paper
/// mode puts there, found by the ray of paper mode's pixel. In perspective mode the two are one.
struct ModeDifference {
  std::vector<float> displacement_mm;  ///< per texel of the layout; kOutside where the view does not reach
  std::size_t texels = 0;              ///< with a displacement
  std::size_t lost = 0;  ///< in the cutout, but painted with what lies beside surface or picture
  double mean_mm = 0, p95_mm = 0, max_mm = 0;

  static constexpr float kOutside = -1;
};

/// The figures of displacements of the texels: count, mean, 95th percentile and maximum of what is not
/// outside.
ModeDifference figures_of(std::vector<float> displacement_mm, std::size_t lost);

/// Over the cutout's texels that a point in sight stands behind; `view` is one whole part in paper mode,
/// valid. Not real-time. A pinhole, as paper mode's own picture is rectified.
ModeDifference difference_between_modes(const TriangleMesh& mesh, const RayScene& rays,
                                        const AtlasLayout& layout, const CutoutPatch& view, double far_mm);

}  // namespace orcart
