// What the paint is shown as: the pictures themselves, or what is known of each texel as a colour.
#pragma once

#include <array>

#include "render/atlas/painter.hpp"

namespace orcart {

enum class ColourBy : std::uint8_t {
  picture,
  capture,     ///< a hue for each capture
  angle,       ///< between line of sight and normal
  resolution,  ///< what a pixel covers of the surface
  error,       ///< predicted, along the surface
};

/// The value that has the darkest colour of the ramp; 0 has the brightest. Degrees for angle, else mm; 0
/// where there is no ramp.
double end_of_ramp(ColourBy by) noexcept;

/// The ramp's colour, red green blue: 0 the brightest, 1 and beyond the darkest.
std::array<std::uint8_t, 3> ramp_colour(double share) noexcept;

/// The painting with each texel's colour put in place of the picture's; alpha stays. Not real-time.
AtlasPicture coloured(AtlasPicture painting, const AtlasRecords& records, ColourBy by);

}  // namespace orcart
