// What the rules of shaders/*.glsl know of the scope, the view and the settings, as plain numbers: given to
// the driver by PaintProgram, spread over vectors by ProcessorTexels.
#pragma once

#include <glm/glm.hpp>

#include "realtime/geometry/pose.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "render/atlas/paint_settings.hpp"
#include "render/atlas/scope_depth.hpp"

namespace orcart {

/// Nothing but floats, in the order of the shaders' own list.
struct PaintUniforms {
  using real = float;
  using vec2 = glm::vec2;
  using vec3 = glm::vec3;
  using vec4 = glm::vec4;
  using mat3 = glm::mat3;
#define uniform
#include "render/shaders/paint_uniforms.glsl"
#undef uniform
};

/// What is chosen when a program is compiled, or a painter made.
struct PaintChoices {
  int lens_model = 0;  ///< as LENS_MODEL of shaders/lens.glsl
  bool best = false, yield = false, light = false;
};
PaintChoices choices_of(const ScopeModel& scope, const PainterSettings& settings) noexcept;

/// What stays the same from view to view; the rest as of a scope at its passport's turn, with its residuals
/// as the view's error.
PaintUniforms uniforms_of(const ScopeModel& scope, const PainterSettings& settings, double texel_mm,
                          const DepthPinhole& pinhole);
void set_pose(PaintUniforms& uniforms, const Pose<C, M>& X_CM) noexcept;
/// At the turn of the scope's light post.
void set_optics(PaintUniforms& uniforms, const TurnedOptics& optics) noexcept;

}  // namespace orcart
