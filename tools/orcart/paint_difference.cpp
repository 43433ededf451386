// Thin: the map does the work.
#include "tools/orcart/paint_difference.hpp"

#include <cstdio>

#include "firmware-host/files/textured_file.hpp"

namespace orcart {

Result<DifferenceMap> difference_of(const Surface& surface, const ScopeModel& scope,
                                    const AtlasLayout& layout, SeenFrom seen_from,
                                    const std::vector<View>& views) {
  auto map = DifferenceMap::create(surface, scope, layout, seen_from);
  if (!map) return map;
  for (const View& view : views)
    if (const auto added = map->add(view.X_MC); !added)
      return fail(view.image.string() + ": " + added.error().message);
  return map;
}

Result<void> write_difference(const std::string& file, const DifferenceMap& map, const Surface& surface,
                              std::span<const std::array<Eigen::Vector2f, 3>> places, const View& last) {
  if (file.ends_with(".png")) {
    const Picture picture = map.picture(last.X_MC, last.turn_rad);
    return write_png(file, picture.width_px, picture.height_px, picture.rgba);
  }
  const AtlasPicture colours = map.colours();
  return write_textured(file, {.surface = surface,
                               .corners_uv = places,
                               .width_texels = colours.width_texels,
                               .height_texels = colours.height_texels,
                               .rgba = colours.rgba});
}

std::string difference_text(const ModeDifference& difference, const std::string& file) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "paper mode against perspective: mean %.2f, 95 %% below %.2f, max %.2f mm over %zu texels; "
                "%zu more show what lies beside: ",
                difference.mean_mm, difference.p95_mm, difference.max_mm, difference.texels, difference.lost);
  std::array<char, 64> colours{};
  std::snprintf(colours.data(), colours.size(), " (yellow is 0, violet %g mm and beyond)",
                DifferenceMap::kDarkest_mm);
  return text.data() + file + colours.data();
}

std::string difference_json(const ModeDifference& difference) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "\"difference\": {\"mean_mm\": %.4f, \"p95_mm\": %.4f, \"max_mm\": %.4f, \"texels\": %zu, "
                "\"lost\": %zu}, ",
                difference.mean_mm, difference.p95_mm, difference.max_mm, difference.texels, difference.lost);
  return text.data();
}

}  // namespace orcart
