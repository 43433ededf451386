// Rows by the format's own planes; compression by zlib.
#include "firmware-host/session/picture_bytes.hpp"

#include <cstring>

#include <zlib.h>

namespace orcart {

std::size_t copy_packed(const ImageDescriptor& image, std::span<std::byte> into) noexcept {
  const std::size_t size = packed_bytes(image.format, image.width_px, image.height_px);
  if (size == 0 || size > into.size()) return 0;
  const ImageDescriptor packed = packed_image(into.data(), image.format, image.width_px, image.height_px);
  for (int p = 0; p < packed.plane_count; ++p) {
    const ImagePlane &from = image.planes[static_cast<std::size_t>(p)],
                     &to = packed.planes[static_cast<std::size_t>(p)];
    if (from.data == nullptr) return 0;
    const int rows = p == 0 ? image.height_px : image.height_px / 2;
    for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r)
      std::memcpy(to.data + to.offset_bytes + r * to.stride_bytes,
                  from.data + from.offset_bytes + r * from.stride_bytes, to.stride_bytes);
  }
  return size;
}

std::span<const std::byte> deflated(std::span<const std::byte> bytes, std::vector<std::byte>& buffer) {
  uLongf size = compressBound(bytes.size());
  buffer.resize(size);
  compress2(reinterpret_cast<Bytef*>(buffer.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
            bytes.size(),
            Z_BEST_SPEED);  // cannot fail: the buffer has room for the worst case
  return std::span(buffer).first(size);
}

Result<std::vector<std::byte>> inflated(std::span<const std::byte> bytes, std::size_t size_bytes) {
  std::vector<std::byte> unfolded(size_bytes);
  uLongf size = size_bytes;
  const int code = uncompress(reinterpret_cast<Bytef*>(unfolded.data()), &size,
                              reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (code != Z_OK || size != size_bytes)
    return fail("a picture of " + std::to_string(size_bytes) + " bytes is damaged and was not read");
  return unfolded;
}

}  // namespace orcart
