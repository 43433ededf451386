// A mapper of its own gives each view's cutout in paper mode.
#include "firmware-host/offline/difference_map.hpp"

#include "firmware-host/offline/texel_values.hpp"
#include "realtime/optics/scope_turn.hpp"

namespace orcart {

DifferenceMap::DifferenceMap(const Surface& surface, const ScopeModel& scope, const AtlasLayout& layout,
                             RayScene rays, Mapper mapper, const MapperLimits& limits)
    : surface_(&surface),
      scope_(&scope),
      layout_(&layout),
      rays_(std::move(rays)),
      mapper_(std::move(mapper)),
      patch_(patch_capacity(limits)),
      displacement_mm_(layout.owners.size(), ModeDifference::kOutside) {}

Result<DifferenceMap> DifferenceMap::create(const Surface& surface, const ScopeModel& scope,
                                            const AtlasLayout& layout, SeenFrom seen_from) {
  auto rays = RayScene::create(surface.mesh);
  if (!rays) return tl::unexpected(rays.error());
  const MapperLimits limits{
      .max_triangles_per_step = static_cast<std::uint32_t>(surface.mesh.triangles.size()) + 48,
      .max_rays_per_step = 1U << 31U};
  auto mapper = Mapper::create(surface, seen_from, scope, limits);
  if (!mapper) return tl::unexpected(mapper.error());
  return DifferenceMap(surface, scope, layout, *std::move(rays), *std::move(mapper), limits);
}

Result<void> DifferenceMap::add(const Pose<M, C>& X_MC) {
  mapper_.begin(X_MC, TextureMode::paper);
  if (!mapper_.next(patch_) || !patch_.paper.valid)
    return fail("the central ray misses the surface, so paper mode has no scale for this view");
  const ModeDifference view =
      difference_between_modes(surface_->mesh, rays_, *layout_, patch_, scope_->far_mm);
  for (std::size_t i = 0; i < displacement_mm_.size(); ++i)
    if (view.displacement_mm[i] >= 0) displacement_mm_[i] = view.displacement_mm[i];
  lost_ += view.lost;
  return {};
}

ModeDifference DifferenceMap::figures() const {
  return figures_of(displacement_mm_, lost_);
}

AtlasPicture DifferenceMap::colours() const {
  return colours_of({.layout = *layout_, .values = displacement_mm_, .darkest = kDarkest_mm});
}

Picture DifferenceMap::picture(const Pose<M, C>& X_MC, double turn_rad) const {
  return seen_by_scope({.layout = *layout_, .values = displacement_mm_, .darkest = kDarkest_mm},
                       surface_->mesh, rays_, turned(*scope_, turn_rad), X_MC);
}

}  // namespace orcart
