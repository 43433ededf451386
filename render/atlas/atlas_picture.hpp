// A picture that was read back.
#pragma once

#include <cstdint>
#include <vector>

namespace orcart {

/// Straight RGBA, row 0 first as in AtlasLayout; alpha 0 where nothing was painted. Of a view: opaque.
struct AtlasPicture {
  int width_texels = 0, height_texels = 0;
  std::vector<std::uint8_t> rgba;
};

}  // namespace orcart
