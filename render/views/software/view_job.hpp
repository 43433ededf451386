// What a processor needs to draw the surface for an eye by itself: plain memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "render/atlas/painter.hpp"
#include "render/views/view_drawing.hpp"

namespace orcart {

/// A mesh's vertices, a number after the other of each; readable a vector's length beyond.
struct VertexNumbers {
  const float *x = nullptr, *y = nullptr, *z = nullptr;     ///< M, mm
  const float *nx = nullptr, *ny = nullptr, *nz = nullptr;  ///< normal
  const float *u = nullptr, *v = nullptr;                   ///< place in the atlas, texels
  std::size_t count = 0;
};

/// A vertex as an eye sees it.
struct alignas(32) SeenVertex {
  float x_px, y_px;
  float nearness;   ///< 1 / distance along the line of sight (1/mm); not positive before the near plane
  float facing;     ///< cosine between normal and line of sight
  float u, v;       ///< place in the atlas, 1/16 texel
  float bare, lit;  ///< light on bare tissue and on paint, 1/65535
};

/// Where each pixel lies in the atlas; rows of `stride` pixels, the first not before 16 others, the last
/// before as many.
struct PlacePicture {
  float* nearness = nullptr;       ///< 0: nothing is seen
  std::uint32_t* place = nullptr;  ///< x and, from bit 16 on, y, 1/16 texel
  std::uint32_t* light =
      nullptr;  ///< on bare tissue and, from bit 16 on, on paint, 1/65535; 0: nothing is seen
  int width = 0, height = 0, stride = 0;
};

struct ViewJob {
  EyeMatrices from;
  float near_mm = 1;
  VertexNumbers vertices;
  SeenVertex* seen_vertices = nullptr;  ///< as many, and a vector more
  PlacePicture places;
  float facing_area = -1;  ///< sign of the area, in pixels with y down, of the triangles that are drawn
  std::uint32_t* shell = nullptr;  ///< of the shell, premultiplied, as places
};

struct ShadeJob {
  PlacePicture places;
  PaintedAtlas paint;
  ColourBy colour_by = ColourBy::picture;
  float end_of_ramp = 1;
  const std::uint32_t* shell = nullptr;  ///< none: no shell
  std::uint32_t* shown = nullptr;        ///< as places
};

// Any thread; they allocate nothing.
/// Fills `seen_vertices`.
void see_vertices(const ViewJob& job) noexcept;
/// Three of `indices` a triangle: into `places` where it is nearest.
void see_triangles(const ViewJob& job, std::span<const std::uint32_t> indices) noexcept;
/// The same over each other into `shell`, where `places` has nothing nearer.
void draw_glass(const ViewJob& job, std::span<const std::uint32_t> indices) noexcept;
/// Colours at least this part.
void shade_pixels(const ShadeJob& job, const PixelBox& part) noexcept;

}  // namespace orcart
