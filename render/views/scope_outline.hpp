// The scope drawn over the view: its shaft, its viewing cone and a crosshair at the distal window.
#pragma once

#include <optional>

#include "realtime/geometry/pose.hpp"
#include "render/hud/hud_canvas.hpp"
#include "render/views/eye.hpp"

namespace orcart {

struct ScopeOutline {
  Pose<M, C> X_MC;
  Pose<C, E> X_CE;
  /// Its direction towards the tip, in C; nothing: not known, and not drawn.
  std::optional<Eigen::Vector3d> shaft = Eigen::Vector3d::UnitZ();
  double cone_half_angle_rad = 0;
  bool predicted = false;  ///< dashed: not measured, extrapolated
};

/// Strokes within `view`, the part of the panel that shows the surface as `eye` sees it.
void draw_scope(HudCanvas& canvas, const HudBox& view, const Eye& eye, const ScopeOutline& outline) noexcept;

}  // namespace orcart
