// What a processor needs to draw the live picture's inset by itself: plain memory.
#pragma once

#include <cstdint>

#include "render/atlas/paint_uniforms.hpp"
#include "render/gles/picture_planes.hpp"

namespace orcart {

struct InsetJob {
  PaintUniforms uniforms;  ///< of them u_circle, u_aspect, u_picture_size
  gles::PicturePlanes picture;
  float centre_x = 0, centre_y = 0;       ///< of the inset, from the box's corner, px
  float radius_px = 0;                    ///< of the inset
  int width = 0, height = 0, stride = 0;  ///< of the box, px; a row's vectors stay within its stride
  const std::uint32_t* under = nullptr;   ///< RGBA, the first in the lowest byte: what the inset lies on
  std::uint32_t* shown = nullptr;         ///< the box with the inset
};

/// By the rules of shaders/inset.glsl. Any thread; allocates nothing.
void draw_inset(const InsetJob& job) noexcept;

}  // namespace orcart
