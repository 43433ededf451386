// A mapper of its own gives each view's cutout in paper mode.
#include "firmware-host/offline/difference_map.hpp"

#include <algorithm>
#include <cmath>

#include "render/atlas/colouring.hpp"

namespace orcart {
namespace {

/// The mean, 95th percentile and maximum of what is not outside.
ModeDifference figures_of(std::vector<float> displacement_mm, std::size_t lost) {
  ModeDifference figures{.displacement_mm = std::move(displacement_mm), .lost = lost};
  std::vector<float> sorted;
  for (const float mm : figures.displacement_mm)
    if (mm >= 0) sorted.push_back(mm);
  if (sorted.empty()) return figures;
  std::sort(sorted.begin(), sorted.end());
  figures.texels = sorted.size();
  for (const float mm : sorted)
    figures.mean_mm += static_cast<double>(mm) / static_cast<double>(sorted.size());
  figures.p95_mm = static_cast<double>(sorted[sorted.size() * 95 / 100]);
  figures.max_mm = static_cast<double>(sorted.back());
  return figures;
}

/// Displacements with those of the charts' rims carried on into the gutters, so that a viewer that looks
/// between texels sees no seams.
std::vector<float> with_gutters(const AtlasLayout& layout, std::vector<float> displacement_mm) {
  constexpr int kReach = 2;
  const std::vector<float> own = displacement_mm;
  const auto chart_of = [&](std::size_t i) { return layout.chart_of_triangle[layout.owners[i].triangle]; };
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (layout.inside[i] != 0 || layout.owners[i].triangle == TexelOwner{}.triangle) continue;
    const int x = static_cast<int>(i) % layout.width_texels, y = static_cast<int>(i) / layout.width_texels;
    int nearest = 2 * kReach * kReach + 1;
    for (int v = std::max(0, y - kReach); v <= std::min(layout.height_texels - 1, y + kReach); ++v)
      for (int u = std::max(0, x - kReach); u <= std::min(layout.width_texels - 1, x + kReach); ++u) {
        const auto other = static_cast<std::size_t>(v * layout.width_texels + u);
        const int away = (u - x) * (u - x) + (v - y) * (v - y);
        if (own[other] < 0 || away >= nearest || chart_of(other) != chart_of(i)) continue;
        nearest = away;
        displacement_mm[i] = own[other];
      }
  }
  return displacement_mm;
}

}  // namespace

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
  AtlasPicture picture{.width_texels = layout_->width_texels, .height_texels = layout_->height_texels};
  const std::vector<float> shown_mm = with_gutters(*layout_, displacement_mm_);
  picture.rgba.assign(4 * shown_mm.size(), 0);
  for (std::size_t i = 0; i < shown_mm.size(); ++i) {
    if (shown_mm[i] < 0) continue;
    const auto colour = ramp_colour(static_cast<double>(shown_mm[i]) / kDarkest_mm);
    std::copy(colour.begin(), colour.end(), picture.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    picture.rgba[4 * i + 3] = 255;
  }
  return picture;
}

Picture DifferenceMap::picture(const Pose<M, C>& X_MC) const {
  Picture picture{.width_px = scope_->width_px, .height_px = scope_->height_px, .rgba = {}};
  picture.rgba.reserve(4 * static_cast<std::size_t>(picture.width_px) *
                       static_cast<std::size_t>(picture.height_px));
  const Eigen::Vector3f tip = X_MC.translation_mm.cast<float>();
  const std::vector<float> shown_mm = with_gutters(*layout_, displacement_mm_);
  const double least_cosine = std::cos(scope_->cone_half_angle_rad);
  for (int y = 0; y < picture.height_px; ++y)
    for (int x = 0; x < picture.width_px; ++x) {
      std::array<std::uint8_t, 3> colour{255, 255, 255};
      const auto direction = direction_of(scope_->lens, {x, y});
      if (direction && direction->z() >= least_cosine) {
        const Eigen::Vector3f ray = (X_MC.rotation * *direction).cast<float>();
        if (const auto hit = rays_.nearest(tip, ray, static_cast<float>(scope_->far_mm)))
          colour = colour_at(*hit, ray, shown_mm);
      }
      picture.rgba.insert(picture.rgba.end(), {colour[0], colour[1], colour[2], 255});
    }
  return picture;
}

std::array<std::uint8_t, 3> DifferenceMap::colour_at(const RayHit& hit, const Eigen::Vector3f& ray,
                                                     const std::vector<float>& shown_mm) const {
  const auto& t = surface_->mesh.triangles[hit.triangle];
  const Eigen::Vector3f a = surface_->mesh.vertices_mm[t[0]];
  const Eigen::Vector3f normal =
      (surface_->mesh.vertices_mm[t[1]] - a).cross(surface_->mesh.vertices_mm[t[2]] - a).normalized();
  const auto& corners = layout_->corners_texels[hit.triangle];
  const Eigen::Vector2f at =
      corners[0] + hit.b1 * (corners[1] - corners[0]) + hit.b2 * (corners[2] - corners[0]);
  const auto texel =
      static_cast<std::size_t>(static_cast<int>(at.y()) * layout_->width_texels + static_cast<int>(at.x()));
  const float mm = shown_mm[texel], shade = 0.4F + 0.6F * std::abs(normal.dot(ray));
  std::array<std::uint8_t, 3> colour{190, 190, 190};
  if (mm >= 0) colour = ramp_colour(static_cast<double>(mm) / kDarkest_mm);
  for (std::uint8_t& c : colour) c = static_cast<std::uint8_t>(std::lround(shade * static_cast<float>(c)));
  return colour;
}

}  // namespace orcart
