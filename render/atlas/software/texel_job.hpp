// What a processor needs to paint cells of the atlas by itself: plain memory.
#pragma once

#include <cstdint>
#include <span>

#include "render/atlas/paint_uniforms.hpp"
#include "render/atlas/texel_record.hpp"
#include "render/gles/picture_planes.hpp"

namespace orcart {

inline constexpr int kCellTexels = 16;  ///< what is painted is gone through in squares of this size

/// Row 0 first, `width_texels` to a row.
struct TexelMemory {
  int width_texels = 0;
  const float *x_mm = nullptr, *y_mm = nullptr, *z_mm = nullptr,
              *normal = nullptr;     ///< as SurfaceTextures::points
  std::uint32_t* colours = nullptr;  ///< RGBA, the first in the lowest byte, premultiplied
  TexelRecord* records = nullptr;
};

/// Reciprocal depths (1/mm) by the pinhole of the uniforms, u_depth_size texels square.
struct SeenDepths {
  const float* per_mm = nullptr;
  int size_texels = 0;
};

struct TexelJob {
  PaintUniforms uniforms;
  PaintChoices choices;
  gles::PicturePlanes picture;
  SeenDepths depths;
  TexelMemory atlas;
};

/// Paints the texels of these cells (row-major numbers) by the rules of shaders/paint_texel.glsl. Any thread;
/// allocates nothing.
void paint_cells(const TexelJob& job, std::span<const std::uint32_t> cells) noexcept;

}  // namespace orcart
