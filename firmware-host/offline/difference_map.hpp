// Paper mode against perspective over the views of a painting, as colours on the surface and as a picture.
#pragma once

#include <vector>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/offline/mode_difference.hpp"
#include "realtime/mapper/mapper.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/painter.hpp"

namespace orcart {

/// Borrows surface, scope and layout. Not real-time; no OpenGL.
class DifferenceMap {
 public:
  static constexpr double kDarkest_mm = 5;  ///< and beyond: violet; 0 is yellow

  static Result<DifferenceMap> create(const Surface& surface, const ScopeModel& scope,
                                      const AtlasLayout& layout, SeenFrom seen_from);

  /// The newest view wins where views overlap, as in a painting. A view whose centre ray misses is refused:
  /// paper mode has no scale for it. A turn of the light post is in X_MC alone: both modes put rectified rays
  /// against the surface.
  Result<void> add(const Pose<M, C>& X_MC);

  /// Displacements of the texels; their mean, 95th percentile and maximum; `lost` over all views.
  ModeDifference figures() const;
  /// The ramp's colour at each texel; alpha 0 outside of the views.
  AtlasPicture colours() const;
  /// The surface as the scope at X_MC sees it, shaded, in those colours; grey outside of the views. Of the
  /// scope's size, through its lens at the turn of its light post.
  Picture picture(const Pose<M, C>& X_MC, double turn_rad = 0) const;

 private:
  DifferenceMap(const Surface& surface, const ScopeModel& scope, const AtlasLayout& layout, RayScene rays,
                Mapper mapper, const MapperLimits& limits);

  const Surface* surface_;
  const ScopeModel* scope_;
  const AtlasLayout* layout_;
  RayScene rays_;
  Mapper mapper_;
  CutoutPatch patch_;
  std::vector<float> displacement_mm_;
  std::size_t lost_ = 0;
};

}  // namespace orcart
