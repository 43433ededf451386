// Any bytes as a frame of motion JPEG: decoded or damaged, never out of the picture's memory.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "board/linux/v4l2/mjpeg_decoder.hpp"

namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr std::byte kGuard{0xA5};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static auto decoder = orcart::MjpegDecoder::create(kWidth, kHeight);
  if (!decoder) std::abort();
  static std::array<std::byte, kWidth * kHeight * 4 + 64> pixels;
  pixels.fill(kGuard);
  const auto image = orcart::packed_image(pixels.data(), orcart::PixelFormat::rgba8888, kWidth, kHeight);
  (void)decoder->decode({reinterpret_cast<const std::byte*>(data), size}, image);
  for (std::size_t i = pixels.size() - 64; i < pixels.size(); ++i)
    if (pixels[i] != kGuard) __builtin_trap();
  return 0;
}
