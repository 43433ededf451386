// Rows of means; the inner loops are written so that compilers make vector code of them.
#include "render/gles/picture_pyramid.hpp"

namespace orcart::gles {
namespace {

template <int Channels>
void halve_row(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* out, int width) noexcept {
  for (int x = 0; x < width; ++x) {
    for (int c = 0; c < Channels; ++c) {
      const int i = 2 * Channels * x + c, j = i + Channels;
      out[Channels * x + c] = static_cast<std::uint8_t>((above[i] + above[j] + below[i] + below[j] + 2) / 4);
    }
  }
}

void halve(const PlaneView& from, int channels, std::uint8_t* to) noexcept {
  const int width = from.width / 2;
  for (int y = 0; y < from.height / 2; ++y) {
    const std::uint8_t* above = from.data + 2 * static_cast<std::size_t>(y) * from.stride_bytes;
    const std::uint8_t* below = above + from.stride_bytes;
    std::uint8_t* out = to + static_cast<std::size_t>(y) * static_cast<std::size_t>(width * channels);
    if (channels == 1) halve_row<1>(above, below, out, width);
    if (channels == 2) halve_row<2>(above, below, out, width);
    if (channels == 4) halve_row<4>(above, below, out, width);
  }
}

}  // namespace

int exact_halvings(int width, int height, int most) noexcept {
  int halvings = 0;
  while (halvings < most && width % 2 == 0 && height % 2 == 0) {
    ++halvings;
    width /= 2;
    height /= 2;
  }
  return halvings;
}

PicturePyramid::PicturePyramid(int width, int height, int channels, int levels)
    : width_(width), height_(height), channels_(channels) {
  for (int level = 1; level <= levels; ++level)
    levels_.emplace_back(static_cast<std::size_t>(width >> level) *
                         static_cast<std::size_t>(height >> level) * static_cast<std::size_t>(channels));
}

void PicturePyramid::build(const PlaneView& plane) noexcept {
  PlaneView from = plane;
  for (std::vector<std::uint8_t>& to : levels_) {
    halve(from, channels_, to.data());
    const int width = from.width / 2;
    from = {to.data(), static_cast<std::size_t>(width * channels_), width, from.height / 2};
  }
}

}  // namespace orcart::gles
