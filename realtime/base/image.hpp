// The one image descriptor that board and render both know: CPU planes or dma-bufs, never copied, never
// owned.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace orcart {

constexpr std::uint32_t fourcc(char a, char b, char c, char d) {
  return static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b) << 8 |
         static_cast<std::uint32_t>(c) << 16 | static_cast<std::uint32_t>(d) << 24;
}

/// Pixel formats by their V4L2/DRM four-character code. YUV is BT.601, limited range, chroma sited left
/// (MPEG-2).
enum class PixelFormat : std::uint32_t {
  none = 0,
  yuyv = fourcc('Y', 'U', 'Y', 'V'),      ///< packed 4:2:2, one plane
  uyvy = fourcc('U', 'Y', 'V', 'Y'),      ///< packed 4:2:2, one plane
  nv12 = fourcc('N', 'V', '1', '2'),      ///< planar 4:2:0, two planes: Y, interleaved CbCr
  rgba8888 = fourcc('A', 'B', '2', '4'),  ///< bytes R G B A (DRM_FORMAT_ABGR8888)
  xrgb8888 = fourcc('X', 'R', '2', '4'),  ///< bytes B G R X (DRM_FORMAT_XRGB8888), what panels scan out
  gray8 = fourcc('G', 'R', 'E', 'Y'),     ///< one byte a pixel
};

/// Never the same twice in a process, unlike a descriptor's number, which the next buffer may get. Any
/// thread.
inline std::uint64_t new_dma_buf_id() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

/// One plane: memory of this process, or a dma-buf. Row r starts at data + offset_bytes + r * stride_bytes.
struct ImagePlane {
  std::byte* data = nullptr;     ///< null where the plane lives only in a dma-buf
  int dma_buf_fd = -1;           ///< borrowed; -1 where there is none
  std::uint64_t dma_buf_id = 0;  ///< new_dma_buf_id() of the buffer, by which an importer knows it again
  std::uint32_t offset_bytes = 0;
  std::uint32_t stride_bytes = 0;
};

/// A picture somebody else owns. The first row is the top one; pixel (0,0) is centred on (0.0, 0.0).
struct ImageDescriptor {
  int width_px = 0;
  int height_px = 0;
  PixelFormat format = PixelFormat::none;
  std::uint64_t modifier = 0;  ///< DRM format modifier of the dma-bufs; 0 is linear
  std::array<ImagePlane, 3> planes{};
  int plane_count = 0;
};

/// Bytes that a tightly packed picture takes (rows without padding).
constexpr std::size_t packed_bytes(PixelFormat format, int width_px, int height_px) {
  const std::size_t pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  switch (format) {
    case PixelFormat::yuyv:
    case PixelFormat::uyvy:
      return pixels * 2;
    case PixelFormat::nv12:
      return pixels * 3 / 2;
    case PixelFormat::rgba8888:
    case PixelFormat::xrgb8888:
      return pixels * 4;
    case PixelFormat::gray8:
      return pixels;
    case PixelFormat::none:
      break;
  }
  return 0;
}

/// Describes a tightly packed picture that starts at `data`.
constexpr ImageDescriptor packed_image(std::byte* data, PixelFormat format, int width_px, int height_px) {
  ImageDescriptor image{.width_px = width_px, .height_px = height_px, .format = format};
  const auto width = static_cast<std::uint32_t>(width_px);
  const auto luma_bytes = width * static_cast<std::uint32_t>(height_px);
  image.plane_count = format == PixelFormat::nv12 ? 2 : 1;
  std::uint32_t stride = width;
  if (format == PixelFormat::yuyv || format == PixelFormat::uyvy) stride = width * 2;
  if (format == PixelFormat::rgba8888 || format == PixelFormat::xrgb8888) stride = width * 4;
  image.planes[0] = {.data = data, .stride_bytes = stride};
  if (format == PixelFormat::nv12)
    image.planes[1] = {.data = data, .offset_bytes = luma_bytes, .stride_bytes = width};
  return image;
}

}  // namespace orcart
