// Paints recorded views with the very mapper and painter that run on the cart.
#include "firmware-host/offline/offline_painter.hpp"

namespace orcart {

Result<OfflinePainter> OfflinePainter::create(const Surface& surface, const ScopeModel& scope,
                                              const OfflinePaintOptions& options) {
  OfflinePainter self;
  self.scope_ = scope;
  self.options_ = options;
  auto context = GlContext::create();
  if (!context) return tl::unexpected(context.error());
  if (auto current = context->make_current(); !current) return tl::unexpected(current.error());
  self.context_ = std::make_unique<GlContext>(std::move(*context));

  auto layout = build_atlas(surface.mesh, {.texel_mm = options.texel_mm});
  if (!layout) return tl::unexpected(layout.error());
  self.layout_ = std::make_unique<AtlasLayout>(std::move(*layout));

  // A view in one part: nothing waits here, and by then all that hides is known.
  const MapperLimits limits{
      .max_triangles_per_step = static_cast<std::uint32_t>(surface.mesh.triangles.size()) + 48,
      .max_rays_per_step = 1u << 31};
  auto mapper = Mapper::create(surface, options.seen_from, scope, limits);
  if (!mapper) return tl::unexpected(mapper.error());
  self.mapper_ = std::make_unique<Mapper>(std::move(*mapper));
  self.patch_ = CutoutPatch(patch_capacity(limits));

  auto painter = Painter::create(surface, *self.layout_, scope,
                                 {.seen_from = options.seen_from,
                                  .policy = options.policy,
                                  .highlights = options.highlights,
                                  .light = options.light,
                                  .paint_by = paint_by_for(self.context_->render_class())});
  if (!painter) return tl::unexpected(painter.error());
  self.painter_ = std::make_unique<Painter>(std::move(*painter));
  return self;
}

Result<ViewPainted> OfflinePainter::paint(const ImageDescriptor& image, const Pose<M, C>& X_MC,
                                          double turn_rad) {
  if (image.width_px != scope_.width_px || image.height_px != scope_.height_px) {
    return fail("the picture is " + std::to_string(image.width_px) + "x" + std::to_string(image.height_px) +
                " pixels, the scope's calibration is for " + std::to_string(scope_.width_px) + "x" +
                std::to_string(scope_.height_px) +
                "; bring pictures of that size or the calibration of this mode");
  }
  const std::uint32_t unit = next_unit_++;
  painter_->upload(image);
  painter_->set_turn(turn_rad);
  ViewPainted result;
  mapper_->begin(X_MC, options_.mode);
  while (mapper_->next(patch_)) {
    if (options_.mode == TextureMode::paper && !patch_.paper.valid) {
      return fail("the central ray misses the surface, so paper mode has no scale for this view");
    }
    result.triangles += static_cast<std::uint32_t>(patch_.triangles.size());
    PaintReport report = painter_->paint(patch_, unit);
    result.texels += report.texels;
    while (report.carried) {
      report = painter_->paint_more();
      result.texels += report.texels;
    }
  }
  return result;
}

}  // namespace orcart
