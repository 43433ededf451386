// In blocks of 16 x 16 pixels, so that both sides stay in the cache.
#include "board/linux/kms/turned_copy.hpp"

#include <algorithm>
#include <cstring>

namespace orcart {
namespace {

constexpr int kBlock = 16;

struct Point {
  int x, y;
};

/// Where a pixel of the picture lies on the panel.
Point on_panel(int x, int y, const ImageDescriptor& from, Rotation rotation) {
  switch (rotation) {
    case Rotation::quarter:
      return {y, from.width_px - 1 - x};
    case Rotation::half:
      return {from.width_px - 1 - x, from.height_px - 1 - y};
    case Rotation::three_quarters:
      return {from.height_px - 1 - y, x};
    case Rotation::none:
      break;
  }
  return {x, y};
}

std::byte* pixel(const ImageDescriptor& image, int x, int y) {
  const ImagePlane& plane = image.planes[0];
  return plane.data + plane.offset_bytes + static_cast<std::size_t>(y) * plane.stride_bytes +
         static_cast<std::size_t>(x) * 4;
}

}  // namespace

void copy_turned(const ImageDescriptor& from, const ImageDescriptor& to, Rotation rotation) noexcept {
  for (int top = 0; top < from.height_px; top += kBlock) {
    for (int left = 0; left < from.width_px; left += kBlock) {
      const int bottom = std::min(top + kBlock, from.height_px),
                right = std::min(left + kBlock, from.width_px);
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const Point there = on_panel(x, y, from, rotation);
          std::memcpy(pixel(to, there.x, there.y), pixel(from, x, y), 4);
        }
      }
    }
  }
}

}  // namespace orcart
