// The scope drawn over the view: its shaft, its viewing cone and a crosshair at the distal window.
#pragma once

#include "realtime/optics/scope_model.hpp"
#include "render/hud/hud_canvas.hpp"
#include "render/views/eye.hpp"

namespace orcart {

struct ScopeOutline {
  Pose<M, C> X_MC;
  bool predicted = false;  ///< dashed: not measured, extrapolated
};

/// Strokes within `view`, the part of the panel that shows the surface as `eye` sees it.
void draw_scope(HudCanvas& canvas, const HudBox& view, const Eye& eye, const ScopeModel& scope,
                const ScopeOutline& outline) noexcept;

}  // namespace orcart
