// Who draws the surface for an eye: the driver (GpuView), or, where that is software, the processor's vector
// units (software/processor_view). Both by the rules of shaders/view.glsl.
#pragma once

#include <cstdint>

#include "render/atlas/colouring.hpp"
#include "render/views/eye.hpp"
#include "render/views/view_mesh.hpp"

namespace orcart {

struct SurfaceViewSettings {
  int width_px = 1280, height_px = 800;
  SeenFrom seen_from = SeenFrom::outside;  ///< inside: the near wall is a glass shell, so that one looks in
  ColourBy colour_by = ColourBy::picture;
  /// Of one draw(): a surface with more is drawn coarser for a new eye, and then finer, part by part.
  std::size_t most_triangles = 50'000;
  PaintBy draw_by = PaintBy::gpu;  ///< processor: only what a painter painted that paints so too
};

/// Of no paint: linear 0..1.
inline constexpr std::array<float, 3> kViewGround{0.055F, 0.062F, 0.075F};

enum class Fineness : std::uint8_t { fine, coarse };

/// The surface's meshes, by Fineness; the coarse one is empty where the fine one is small enough.
using ViewMeshes = std::array<ViewMesh, 2>;

struct IndexRange {
  std::size_t first = 0, count = 0;
};
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;

  bool empty() const noexcept { return width <= 0 || height <= 0; }
};

/// The thread whose GL context is current. Allocates nothing of its own once made.
class ViewDrawing {
 public:
  virtual ~ViewDrawing() = default;
  /// Draws these indices of a mesh into its picture of places (where each pixel lies in the atlas, how much
  /// light falls on it), which those from 0 on clear first.
  virtual void see(Fineness mesh, const IndexRange& indices, const EyeMatrices& from) noexcept = 0;
  /// Inside: the mesh's near wall, over what see() found of it.
  virtual void draw_shell(Fineness mesh, const EyeMatrices& from) noexcept = 0;
  /// Colours this part of the kept picture, by that mesh's picture of places and the paint of now.
  virtual void shade(Fineness mesh, const PaintedAtlas& paint, const PixelBox& part) noexcept = 0;
  virtual std::uint32_t framebuffer() const noexcept = 0;  ///< GL name: the kept picture
};

}  // namespace orcart
