// The twin of shaders/colouring.glsl.
#include "render/atlas/colouring.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace orcart {
namespace {

using Rgb = std::array<double, 3>;

// Viridis (Smith and van der Walt 2015) at five places, brightest first: told apart by those who do not see
// all colours.
constexpr std::array<Rgb, 5> kRamp{{{0.993, 0.906, 0.144},
                                    {0.369, 0.789, 0.383},
                                    {0.128, 0.567, 0.551},
                                    {0.229, 0.322, 0.546},
                                    {0.267, 0.005, 0.329}}};

Rgb on_ramp(double share) {
  const double at = 4 * std::clamp(share, 0.0, 1.0);
  const auto first = std::min<std::size_t>(3, static_cast<std::size_t>(at));
  const double weight = at - static_cast<double>(first);
  Rgb colour{};
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = (1 - weight) * kRamp[first][c] + weight * kRamp[first + 1][c];
  return colour;
}

/// Hues a golden section apart.
Rgb hue_of(std::uint16_t capture) {
  const double hue = std::fmod(capture * 0.618034, 1.0);
  Rgb colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double away = std::abs(std::fmod(hue + static_cast<double>(c) / 3, 1.0) * 6 - 3) - 1;
    colour[c] = 0.35 + 0.6 * std::clamp(away, 0.0, 1.0);
  }
  return colour;
}

Rgb colour_of(const TexelRecord& record, ColourBy by) {
  switch (by) {
    case ColourBy::angle:
      return on_ramp(record.angle_cdeg / 100.0 / end_of_ramp(by));
    case ColourBy::resolution:
      return on_ramp(record.footprint_um / 1000.0 / end_of_ramp(by));
    case ColourBy::error:
      return on_ramp(record.error_um / 1000.0 / end_of_ramp(by));
    case ColourBy::capture:
    case ColourBy::picture:
      break;
  }
  return hue_of(record.capture);
}

}  // namespace

double end_of_ramp(ColourBy by) noexcept {
  switch (by) {
    case ColourBy::angle:
      return 80;
    case ColourBy::resolution:
      return 0.5;
    case ColourBy::error:
      return 2;
    case ColourBy::picture:
    case ColourBy::capture:
      break;
  }
  return 0;
}

std::array<std::uint8_t, 3> ramp_colour(double share) noexcept {
  const Rgb colour = on_ramp(share);
  std::array<std::uint8_t, 3> bytes{};
  for (std::size_t c = 0; c < 3; ++c) bytes[c] = static_cast<std::uint8_t>(std::lround(255 * colour[c]));
  return bytes;
}

AtlasPicture coloured(AtlasPicture painting, const AtlasRecords& records, ColourBy by) {
  if (by == ColourBy::picture) return painting;
  for (std::size_t i = 0; i < records.texels.size(); ++i) {
    if (painting.rgba[4 * i + 3] == 0) continue;
    const Rgb colour = colour_of(records.texels[i], by);
    for (std::size_t c = 0; c < 3; ++c)
      painting.rgba[4 * i + c] = static_cast<std::uint8_t>(std::lround(255 * colour[c]));
  }
  return painting;
}

}  // namespace orcart
