// Numbers of texels shown as colours: on the surface, or as a scope sees it.
#pragma once

#include <vector>

#include "firmware-host/files/picture_file.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/painter.hpp"

namespace orcart {

/// One number a texel of the layout; negative: none. Lent for a call.
struct TexelValues {
  const AtlasLayout& layout;
  const std::vector<float>& values;
  double darkest = 1;  ///< and beyond: violet; 0 is yellow
};

/// The ramp's colours, alpha 0 where there is no number; charts' rims are carried on into the gutters, so
/// that a viewer that looks between texels sees no seams.
AtlasPicture colours_of(const TexelValues& shown);

/// The surface as the scope at X_MC sees it, shaded, in those colours; grey where there is no number, white
/// beside surface and cone. Of the scope's size.
Picture seen_by_scope(const TexelValues& shown, const TriangleMesh& mesh, const RayScene& rays,
                      const ScopeModel& scope, const Pose<M, C>& X_MC);

}  // namespace orcart
