// The mesh is drawn when the eye moves; what it showed is shaded anew when the paint changes.
#include "render/views/surface_view.hpp"

#include <algorithm>
#include <cmath>

#include <GLES3/gl31.h>

#include "render/views/gpu_view.hpp"
#include "render/views/software/processor_view.hpp"

namespace orcart {
namespace {

template <class Drawing>
Result<std::unique_ptr<ViewDrawing>> make(const ViewMeshes& meshes, const SurfaceViewSettings& settings) {
  auto made = Drawing::create(meshes, settings);
  if (!made) return tl::unexpected(made.error());
  return std::make_unique<Drawing>(std::move(*made));
}

}  // namespace

Result<SurfaceView> SurfaceView::create(const Surface& surface, const AtlasLayout& layout,
                                        const SurfaceViewSettings& settings) {
  SurfaceView self;
  self.settings_ = settings;
  for (const auto& v : surface.mesh.vertices_mm) self.bounds_.extend(v);
  ViewMeshes meshes{view_mesh(surface.mesh, layout)};
  if (surface.mesh.triangles.size() > settings.most_triangles)
    meshes[1] = coarser(meshes[0], settings.most_triangles);
  self.fine_indices_ = meshes[0].indices.size();
  self.coarse_indices_ = meshes[1].indices.size();
  const bool by_processor = settings.draw_by == PaintBy::processor;
  auto drawing = by_processor ? make<ProcessorView>(meshes, settings) : make<GpuView>(meshes, settings);
  if (!drawing) return tl::unexpected(drawing.error());
  self.drawing_ = std::move(*drawing);
  return self;
}

PixelBox SurfaceView::draw(const Eye& eye, const PaintedAtlas& paint,
                           const Eigen::AlignedBox3f& changed) noexcept {
  PixelBox part{0, 0, settings_.width_px, settings_.height_px};
  if (looked_ && eye == eye_) {
    const bool was_settled = settled();
    if (!was_settled) refine();
    part = pixels_of(!was_settled && settled() ? bounds_ : changed);
  } else {
    look(eye);
  }
  if (!part.empty())
    drawing_->shade(coarse_indices_ && !settled() ? Fineness::coarse : Fineness::fine, paint, part);
  return part;
}

EyeMatrices SurfaceView::matrices() const noexcept {
  return matrices_of(eye_, static_cast<double>(settings_.width_px) / settings_.height_px);
}

/// The pixels on which a box may be seen: all of them where a corner is not before the eye.
PixelBox SurfaceView::pixels_of(const Eigen::AlignedBox3f& box) const noexcept {
  constexpr float kMargin = 2;
  const Eigen::AlignedBox3f part = box.intersection(bounds_);
  if (part.isEmpty()) return {};
  const Eigen::Array2f size(static_cast<float>(settings_.width_px), static_cast<float>(settings_.height_px));
  const EyeMatrices from = matrices();
  Eigen::AlignedBox2f seen;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f p = part.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner));
    const glm::vec4 clip = from.projection * (from.view * glm::vec4(p.x(), p.y(), p.z(), 1));
    if (clip.w <= 0.01F) return {0, 0, settings_.width_px, settings_.height_px};
    seen.extend(Eigen::Vector2f(clip.x / clip.w * 0.5F + 0.5F, clip.y / clip.w * 0.5F + 0.5F));
  }
  const Eigen::Array2f low = (seen.min().array() * size - kMargin).max(0.0F).min(size);
  const Eigen::Array2f high = (seen.max().array() * size + kMargin).max(0.0F).min(size);
  const auto x = static_cast<int>(low.x()), y = static_cast<int>(low.y());
  return {x, y, static_cast<int>(std::ceil(high.x())) - x, static_cast<int>(std::ceil(high.y())) - y};
}

void SurfaceView::look(const Eye& eye) noexcept {
  looked_ = true;
  eye_ = eye;
  refined_ = 0;
  const Fineness mesh = coarse_indices_ ? Fineness::coarse : Fineness::fine;
  const EyeMatrices from = matrices();
  drawing_->see(mesh, {0, coarse_indices_ ? coarse_indices_ : fine_indices_}, from);
  if (settings_.seen_from == SeenFrom::inside) drawing_->draw_shell(mesh, from);
}

/// Adds the next part of the fine mesh to the picture that will take the coarse one's place.
void SurfaceView::refine() noexcept {
  const IndexRange part{refined_, std::min(3 * settings_.most_triangles, fine_indices_ - refined_)};
  drawing_->see(Fineness::fine, part, matrices());
  refined_ += part.count;
}

void SurfaceView::copy_to(std::uint32_t framebuffer, int x_px, int y_px,
                          const PixelBox& part) const noexcept {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, drawing_->framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  const int right = part.x + part.width, bottom = part.y + part.height;
  glBlitFramebuffer(part.x, part.y, right, bottom, x_px + part.x, y_px + part.y, x_px + right, y_px + bottom,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace orcart
