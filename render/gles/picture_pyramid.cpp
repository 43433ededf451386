// Rows of means as vector code, chosen for the processor when first run (Highway).
#include "render/gles/picture_pyramid.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/gles/picture_pyramid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace orcart::gles::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR
/// Bytes of `a` to `d`, each of them the rounded mean of four.
template <class V>
HWY_INLINE V mean_of(V a, V b, V c, V d) {
  const hn::DFromV<V> bytes;
  const hn::Repartition<std::uint16_t, decltype(bytes)> pairs;
  const auto low = [&](V v) HWY_ATTR { return hn::And(hn::BitCast(pairs, v), hn::Set(pairs, 0x00FF)); };
  const auto high = [&](V v) HWY_ATTR { return hn::ShiftRight<8>(hn::BitCast(pairs, v)); };
  const auto quarter = [&](auto sum) HWY_ATTR { return hn::ShiftRight<2>(hn::Add(sum, hn::Set(pairs, 2))); };
  const auto lows = quarter(hn::Add(hn::Add(low(a), low(b)), hn::Add(low(c), low(d))));
  const auto highs = quarter(hn::Add(hn::Add(high(a), high(b)), hn::Add(high(c), high(d))));
  return hn::BitCast(bytes, hn::Or(lows, hn::ShiftLeft<8>(highs)));
}
#endif

/// A texel is a lane of `Texel`, whose bytes are its channels.
template <class Texel>
void halve_row(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* out, std::size_t width) {
  std::size_t x = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<Texel> texels;
  const hn::Repartition<std::uint8_t, decltype(texels)> bytes;
  const std::size_t lanes = hn::Lanes(texels);
  const auto* first = reinterpret_cast<const Texel*>(above);
  const auto* second = reinterpret_cast<const Texel*>(below);
  for (; x + lanes <= width; x += lanes) {
    hn::Vec<decltype(texels)> a, b, c, d;
    hn::LoadInterleaved2(texels, first + 2 * x, a, b);
    hn::LoadInterleaved2(texels, second + 2 * x, c, d);
    hn::StoreU(
        mean_of(hn::BitCast(bytes, a), hn::BitCast(bytes, b), hn::BitCast(bytes, c), hn::BitCast(bytes, d)),
        bytes, out + x * sizeof(Texel));
  }
#endif
  for (std::size_t i = x * sizeof(Texel); i < width * sizeof(Texel); ++i) {  // bound: a vector
    const std::size_t left = i + i / sizeof(Texel) * sizeof(Texel), right = left + sizeof(Texel);
    out[i] = static_cast<std::uint8_t>((above[left] + above[right] + below[left] + below[right] + 2) / 4);
  }
}

void halve(const PlaneView& from, int channels, std::uint8_t* to) {
  const auto width = static_cast<std::size_t>(from.width) / 2;
  for (int y = 0; y < from.height / 2; ++y) {
    const std::uint8_t* above = from.data + 2 * static_cast<std::size_t>(y) * from.stride_bytes;
    const std::uint8_t* below = above + from.stride_bytes;
    std::uint8_t* out = to + static_cast<std::size_t>(y) * width * static_cast<std::size_t>(channels);
    if (channels == 1) halve_row<std::uint8_t>(above, below, out, width);
    if (channels == 2) halve_row<std::uint16_t>(above, below, out, width);
    if (channels == 4) halve_row<std::uint32_t>(above, below, out, width);
  }
}

}  // namespace orcart::gles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart::gles {

HWY_EXPORT(halve);

int exact_halvings(int width, int height, int most) noexcept {
  int halvings = 0;
  while (halvings < most && width % 2 == 0 && height % 2 == 0) {
    ++halvings;
    width /= 2;
    height /= 2;
  }
  return halvings;
}

PicturePyramid::PicturePyramid(int width, int height, int channels, int levels, Keeps keeps)
    : in_memory_{.width = width, .height = height, .channels = channels, .count = 1 + levels}, keeps_(keeps) {
  constexpr std::size_t kReadBeyond = 4;
  std::size_t end = 0;
  for (int level = keeps == Keeps::all_levels ? 0 : 1; level <= levels; ++level) {
    in_memory_.offset_bytes[static_cast<std::size_t>(level)] = static_cast<std::int32_t>(end);
    end += static_cast<std::size_t>(width >> level) * static_cast<std::size_t>(height >> level) *
           static_cast<std::size_t>(channels);
  }
  bytes_.resize(end + kReadBeyond);
}

void PicturePyramid::build(const PlaneView& plane) noexcept {
  const int channels = in_memory_.channels;
  PlaneView from = plane;
  if (keeps_ == Keeps::all_levels) {
    const auto row_bytes = static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(channels);
    for (int y = 0; y < plane.height; ++y)
      std::memcpy(bytes_.data() + static_cast<std::size_t>(y) * row_bytes,
                  plane.data + static_cast<std::size_t>(y) * plane.stride_bytes, row_bytes);
  }
  for (int number = 1; number <= levels(); ++number) {
    std::uint8_t* to = bytes_.data() + in_memory_.offset_bytes[static_cast<std::size_t>(number)];
    HWY_DYNAMIC_DISPATCH(halve)(from, channels, to);
    const int width = from.width / 2;
    from = {to, static_cast<std::size_t>(width * channels), width, from.height / 2};
  }
}

}  // namespace orcart::gles
#endif
