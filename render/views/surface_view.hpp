// The painted surface from any eye, kept as a picture until the paint or the eye changes; coarser while the
// eye moves.
#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "render/views/view_drawing.hpp"

namespace orcart {

class SurfaceView {
 public:
  static Result<SurfaceView> create(const Surface& surface, const AtlasLayout& layout,
                                    const SurfaceViewSettings& settings);

  /// Draws into the kept picture. For a new eye the mesh; for the same eye only the paint, and only where the
  /// box `changed` of M (mm) is seen, and of a coarse view the next part of the fine one. Allocates nothing
  /// of our own. The part of the picture that is new.
  PixelBox draw(const Eye& eye, const PaintedAtlas& paint, const Eigen::AlignedBox3f& changed) noexcept;
  /// False while draw() would make the same eye's picture finer.
  bool settled() const noexcept { return refined_ == fine_indices_ || !coarse_indices_; }
  /// Copies a part of the kept picture to a framebuffer in which the whole would begin at x_px, y_px.
  void copy_to(std::uint32_t framebuffer, int x_px, int y_px, const PixelBox& part) const noexcept;
  std::uint32_t framebuffer() const noexcept { return drawing_->framebuffer(); }
  const SurfaceViewSettings& settings() const noexcept { return settings_; }

 private:
  SurfaceView() = default;
  PixelBox pixels_of(const Eigen::AlignedBox3f& box) const noexcept;
  EyeMatrices matrices() const noexcept;
  void look(const Eye& eye) noexcept;
  void refine() noexcept;

  SurfaceViewSettings settings_;
  std::unique_ptr<ViewDrawing> drawing_;
  std::size_t fine_indices_ = 0, coarse_indices_ = 0;
  std::size_t refined_ =
      0;  ///< indices of the fine mesh that are drawn for an eye which saw the coarse one first
  bool looked_ = false;
  Eye eye_;
  Eigen::AlignedBox3f bounds_;  ///< of the surface
};

}  // namespace orcart
