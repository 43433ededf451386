// Row by row; a ray a pixel.
#include "firmware-host/offline/texel_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/atlas/colouring.hpp"

namespace orcart {
namespace {

std::vector<float> with_gutters(const AtlasLayout& layout, std::vector<float> values) {
  constexpr int kReach = 2;
  const std::vector<float> own = values;
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
        values[i] = own[other];
      }
  }
  return values;
}

std::array<std::uint8_t, 3> colour_at(const TexelValues& shown, const TriangleMesh& mesh, const RayHit& hit,
                                      const Eigen::Vector3f& ray) {
  const auto& t = mesh.triangles[hit.triangle];
  const Eigen::Vector3f a = mesh.vertices_mm[t[0]];
  const Eigen::Vector3f normal = (mesh.vertices_mm[t[1]] - a).cross(mesh.vertices_mm[t[2]] - a).normalized();
  const auto& corners = shown.layout.corners_texels[hit.triangle];
  const Eigen::Vector2f at =
      corners[0] + hit.b1 * (corners[1] - corners[0]) + hit.b2 * (corners[2] - corners[0]);
  const float value = shown.values[static_cast<std::size_t>(
      static_cast<int>(at.y()) * shown.layout.width_texels + static_cast<int>(at.x()))];
  const float shade = 0.4F + 0.6F * std::abs(normal.dot(ray));
  std::array<std::uint8_t, 3> colour{190, 190, 190};
  if (value >= 0) colour = ramp_colour(static_cast<double>(value) / shown.darkest);
  for (std::uint8_t& c : colour) c = static_cast<std::uint8_t>(std::lround(shade * static_cast<float>(c)));
  return colour;
}

}  // namespace

AtlasPicture colours_of(const TexelValues& shown) {
  AtlasPicture picture{
      .width_texels = shown.layout.width_texels, .height_texels = shown.layout.height_texels, .rgba = {}};
  const std::vector<float> values = with_gutters(shown.layout, shown.values);
  picture.rgba.assign(4 * values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < 0) continue;
    const auto colour = ramp_colour(static_cast<double>(values[i]) / shown.darkest);
    std::copy(colour.begin(), colour.end(), picture.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    picture.rgba[4 * i + 3] = 255;
  }
  return picture;
}

Picture seen_by_scope(const TexelValues& shown, const TriangleMesh& mesh, const RayScene& rays,
                      const ScopeModel& scope, const Pose<M, C>& X_MC) {
  Picture picture{.width_px = scope.width_px, .height_px = scope.height_px, .rgba = {}};
  picture.rgba.reserve(4 * static_cast<std::size_t>(picture.width_px) *
                       static_cast<std::size_t>(picture.height_px));
  const std::vector<float> values = with_gutters(shown.layout, shown.values);
  const TexelValues filled{.layout = shown.layout, .values = values, .darkest = shown.darkest};
  const Eigen::Vector3f tip = X_MC.translation_mm.cast<float>();
  const double least_cosine = std::cos(scope.cone_half_angle_rad);
  for (int y = 0; y < picture.height_px; ++y)
    for (int x = 0; x < picture.width_px; ++x) {
      std::array<std::uint8_t, 3> colour{255, 255, 255};
      const auto direction = direction_of(scope.lens, {x, y});
      if (direction && direction->z() >= least_cosine) {
        const Eigen::Vector3f ray = (X_MC.rotation * *direction).cast<float>();
        if (const auto hit = rays.nearest(tip, ray, static_cast<float>(scope.far_mm)))
          colour = colour_at(filled, mesh, *hit, ray);
      }
      picture.rgba.insert(picture.rgba.end(), {colour[0], colour[1], colour[2], 255});
    }
  return picture;
}

}  // namespace orcart
