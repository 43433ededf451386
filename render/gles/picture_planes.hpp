// Where the bytes of an uploaded picture lie in memory, for a painter that looks there itself.
#pragma once

#include <array>
#include <cstdint>

namespace orcart::gles {

/// One plane in several finenesses, each half the one before; rows without padding. At least 4 readable bytes
/// follow.
struct PictureLevels {
  static constexpr int kMost = 5;
  const std::uint8_t* first = nullptr;                 ///< level 0
  std::array<std::int32_t, kMost> offset_bytes{};      ///< from there
  int width = 0, height = 0, channels = 1, count = 1;  ///< of level 0; 1, 2 or 4 channels of a byte; levels
};

struct PicturePlanes {
  int format = -1;  ///< PICTURE_FORMAT of shaders/picture.glsl
  PictureLevels luma, chroma;
};

}  // namespace orcart::gles
