// Pictures to PNG: bytes to RGB by format, BT.601 backwards where needed, then libpng's simplified interface.
#include "board/sim/picture_png.hpp"

#include <algorithm>
#include <array>
#include <system_error>

#include <png.h>

namespace orcart {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

std::uint8_t byte_at(const ImagePlane& plane, int row, int column) {
  const auto offset = plane.offset_bytes + static_cast<std::size_t>(row) * plane.stride_bytes;
  return std::to_integer<std::uint8_t>(plane.data[offset + static_cast<std::size_t>(column)]);
}

Rgb from_yuv(int y, int u, int v) {
  const double luma = 1.164384 * (y - 16);
  const auto clamp = [](double x) { return static_cast<std::uint8_t>(std::clamp(x + 0.5, 0.0, 255.0)); };
  return {clamp(luma + 1.596027 * (v - 128)), clamp(luma - 0.391762 * (u - 128) - 0.812968 * (v - 128)),
          clamp(luma + 2.017232 * (u - 128))};
}

Rgb pixel(const ImageDescriptor& image, int x, int y) {
  const auto& p = image.planes;
  switch (image.format) {
    case PixelFormat::yuyv:
      return from_yuv(byte_at(p[0], y, 2 * x), byte_at(p[0], y, x / 2 * 4 + 1),
                      byte_at(p[0], y, x / 2 * 4 + 3));
    case PixelFormat::nv12:
      return from_yuv(byte_at(p[0], y, x), byte_at(p[1], y / 2, x / 2 * 2),
                      byte_at(p[1], y / 2, x / 2 * 2 + 1));
    case PixelFormat::rgba8888:
      return {byte_at(p[0], y, 4 * x), byte_at(p[0], y, 4 * x + 1), byte_at(p[0], y, 4 * x + 2)};
    case PixelFormat::xrgb8888:
      return {byte_at(p[0], y, 4 * x + 2), byte_at(p[0], y, 4 * x + 1), byte_at(p[0], y, 4 * x)};
    default: {
      const std::uint8_t grey = byte_at(p[0], y, x);
      return {grey, grey, grey};
    }
  }
}

}  // namespace

std::vector<std::uint8_t> rgb_of(const ImageDescriptor& image) {
  std::vector<std::uint8_t> rgb;
  if (image.format == PixelFormat::none || image.format == PixelFormat::uyvy) return rgb;
  rgb.reserve(packed_bytes(PixelFormat::gray8, image.width_px, image.height_px) * 3);
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const Rgb colour = pixel(image, x, y);
      rgb.insert(rgb.end(), colour.begin(), colour.end());
    }
  return rgb;
}

Result<void> write_picture_png(const std::filesystem::path& file, const ImageDescriptor& image) {
  const std::vector<std::uint8_t> rgb = rgb_of(image);
  if (rgb.empty()) return fail(file.string() + ": a picture of this format cannot be written as PNG");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width_px);
  png.height = static_cast<png_uint_32>(image.height_px);
  png.format = PNG_FORMAT_RGB;
  const std::filesystem::path beside = file.string() + ".part";
  if (png_image_write_to_file(&png, beside.c_str(), 0, rgb.data(), 0, nullptr) == 0)
    return fail(file.string() + " could not be written: " + png.message);
  std::error_code error;
  std::filesystem::rename(beside, file, error);
  if (error) return fail(file.string() + " could not be put in place: " + error.message());
  return {};
}

}  // namespace orcart
