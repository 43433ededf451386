// Where a picture's brightness lies in its bytes, so that it can be read without converting the picture.
#pragma once

#include <cstddef>

#include "realtime/base/image.hpp"

namespace orcart {

/// A pixel's luma in plane 0; of RGB pictures the green channel stands for it.
struct LumaLayout {
  std::size_t step_bytes = 0;  ///< from pixel to pixel; 0 where the format is not known
  std::size_t first_byte = 0;
};

constexpr LumaLayout luma_layout(PixelFormat format) {
  switch (format) {
    case PixelFormat::yuyv:
      return {.step_bytes = 2, .first_byte = 0};
    case PixelFormat::uyvy:
      return {.step_bytes = 2, .first_byte = 1};
    case PixelFormat::nv12:
    case PixelFormat::gray8:
      return {.step_bytes = 1, .first_byte = 0};
    case PixelFormat::rgba8888:
    case PixelFormat::xrgb8888:
      return {.step_bytes = 4, .first_byte = 1};
    case PixelFormat::none:
      break;
  }
  return {};
}

}  // namespace orcart
