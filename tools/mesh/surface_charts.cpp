// Lays the charts out, colours them, writes them.
#include "tools/mesh/surface_charts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "firmware-host/files/textured_file.hpp"
#include "render/atlas/atlas_layout.hpp"

namespace orcart {
namespace {

/// Bright, and unlike the charts before and after: hues a golden angle apart.
std::array<std::uint8_t, 3> colour_of(std::uint32_t chart) {
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double hue = chart * std::numbers::phi + static_cast<double>(c) / 3;
    rgb[c] = static_cast<std::uint8_t>(150 + 90 * std::cos(2 * std::numbers::pi * hue));
  }
  return rgb;
}

std::vector<std::uint8_t> picture_of(const AtlasLayout& layout) {
  std::vector<std::uint8_t> rgba(4 * layout.owners.size());
  for (std::size_t i = 0; i < layout.owners.size(); ++i) {
    const std::uint32_t triangle = layout.owners[i].triangle;
    if (triangle >= layout.chart_of_triangle.size()) continue;
    const auto colour = colour_of(layout.chart_of_triangle[triangle]);
    std::copy(colour.begin(), colour.end(), &rgba[4 * i]);
    rgba[4 * i + 3] = 255;
  }
  return rgba;
}

}  // namespace

Result<ChartReport> write_charts(const Surface& surface, const ChartOutput& output) {
  const auto layout = build_atlas(surface.mesh, {.texel_mm = output.texel_mm});
  if (!layout) return tl::unexpected(layout.error());
  const auto places = picture_places(*layout);
  const auto rgba = picture_of(*layout);
  const auto written = write_textured(output.file, {.surface = surface,
                                                    .corners_uv = places,
                                                    .width_texels = layout->width_texels,
                                                    .height_texels = layout->height_texels,
                                                    .rgba = rgba});
  if (!written) return tl::unexpected(written.error());
  const auto used = std::count(layout->inside.begin(), layout->inside.end(), 1);
  return ChartReport{.file = output.file,
                     .charts = layout->charts.size(),
                     .size_texels = layout->width_texels,
                     .texel_mm = layout->texel_mm,
                     .used_share = static_cast<double>(used) / static_cast<double>(layout->inside.size())};
}

}  // namespace orcart
