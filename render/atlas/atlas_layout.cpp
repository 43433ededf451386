// Charts onto shelves, and every texel to its triangle.
#include "render/atlas/atlas_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "render/atlas/chart_grower.hpp"
#include "render/atlas/texel_raster.hpp"

namespace orcart {
namespace {

/// Shelves, highest charts first; nothing where they do not fit into a square of `size`.
std::optional<std::vector<ChartRect>> pack(const std::vector<Chart>& charts, int size, int gutter) {
  std::vector<std::uint32_t> order(charts.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto extent = [&](std::uint32_t c, int axis) {
    return static_cast<int>(std::ceil(charts[c].size_texels[axis])) + 2 * gutter;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return extent(a, 1) != extent(b, 1) ? extent(a, 1) > extent(b, 1) : extent(a, 0) > extent(b, 0);
  });
  std::vector<ChartRect> rects(charts.size());
  int x = 0, y = 0, shelf = 0;
  for (const std::uint32_t c : order) {
    const int w = extent(c, 0), h = extent(c, 1);
    if (x + w > size) {
      x = 0;
      y += shelf;
      shelf = 0;
    }
    if (w > size || y + h > size) return std::nullopt;
    shelf = std::max(shelf, h);
    rects[c] = {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(w),
                static_cast<std::uint16_t>(h)};
    x += w;
  }
  return rects;
}

void place(const Chart& chart, std::uint32_t number, int gutter, AtlasLayout& layout) {
  const ChartRect& rect = layout.charts[number];
  const Eigen::Vector2f shift(static_cast<float>(rect.x + gutter), static_cast<float>(rect.y + gutter));
  for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
    layout.chart_of_triangle[chart.triangles[i]] = number;
    auto& corners = layout.corners_texels[chart.triangles[i]];
    corners = chart.corners_texels[i];
    for (auto& p : corners) p += shift;
  }
}

/// A texel belongs to the triangle that holds its centre, else to the nearest one of the same chart within
/// the gutter.
void assign_owners(const Chart& chart, int gutter, AtlasLayout& layout, std::vector<float>& distance) {
  for (const std::uint32_t t : chart.triangles) {
    for_each_texel(layout.corners_texels[t], static_cast<float>(gutter) + 0.5f, layout.width_texels,
                   layout.height_texels, [&](int x, int y, float b1, float b2, float d) {
                     const auto i =
                         static_cast<std::size_t>(y) * static_cast<std::size_t>(layout.width_texels) +
                         static_cast<std::size_t>(x);
                     if (distance[i] <= d) return;
                     distance[i] = d;
                     layout.owners[i] = {.triangle = t, .b1 = b1, .b2 = b2};
                     layout.inside[i] = d == 0;
                   });
  }
}

}  // namespace

Result<AtlasLayout> build_atlas(const TriangleMesh& mesh, const AtlasSettings& settings) {
  if (mesh.triangles.empty()) return fail("the surface has no triangles to lay out");
  constexpr double kCoarser = 1.15;
  double texel_mm = settings.texel_mm;
  for (int attempt = 0; attempt < 40; ++attempt, texel_mm *= kCoarser) {
    const std::vector<Chart> charts = grow_charts(mesh, texel_mm);
    for (int size = 256; size <= settings.max_size_texels; size += 256) {
      auto rects = pack(charts, size, settings.gutter_texels);
      if (!rects) continue;
      AtlasLayout layout;
      layout.width_texels = layout.height_texels = size;
      layout.texel_mm = texel_mm;
      layout.charts = std::move(*rects);
      layout.chart_of_triangle.resize(mesh.triangles.size());
      layout.corners_texels.resize(mesh.triangles.size());
      const std::size_t texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
      layout.owners.resize(texels);
      layout.inside.assign(texels, 0);
      std::vector<float> distance(texels, INFINITY);
      for (std::uint32_t c = 0; c < charts.size(); ++c) {
        place(charts[c], c, settings.gutter_texels, layout);
        assign_owners(charts[c], settings.gutter_texels, layout, distance);
      }
      return layout;
    }
  }
  return fail("the surface does not fit into an atlas of " + std::to_string(settings.max_size_texels) +
              " texels at any size of texel; use fewer triangles");
}

std::vector<std::array<Eigen::Vector2f, 3>> picture_places(const AtlasLayout& layout) {
  auto places = layout.corners_texels;
  for (auto& corners : places)
    for (Eigen::Vector2f& corner : corners)
      corner = {corner.x() / static_cast<float>(layout.width_texels),
                1 - corner.y() / static_cast<float>(layout.height_texels)};
  return places;
}

}  // namespace orcart
