// What is kept of each texel besides its colour: who painted it, and how well.
#pragma once

#include <cstdint>
#include <vector>

namespace orcart {

/// One texel of the record texture (RGBA16UI), as it lies in memory.
struct TexelRecord {
  std::uint16_t capture = 0;     ///< capture_number() of the unit that gives most of the colour; 0: bare
  std::uint16_t angle_cdeg = 0;  ///< between line of sight and normal, hundredths of a degree
  std::uint16_t footprint_um =
      0;                       ///< what a pixel covers of the surface in its longer direction, micrometres
  std::uint16_t error_um = 0;  ///< predicted, along the surface, micrometres
};
static_assert(sizeof(TexelRecord) == 8);

/// A unit's number as records hold it: 1..65535, then again from 1.
constexpr std::uint16_t capture_number(std::uint32_t unit) noexcept {
  return static_cast<std::uint16_t>(1 + (unit - 1) % 65535);
}

/// Read back from the GPU, row 0 first as in AtlasLayout.
struct AtlasRecords {
  int width_texels = 0, height_texels = 0;
  std::vector<TexelRecord> texels;
};

}  // namespace orcart
