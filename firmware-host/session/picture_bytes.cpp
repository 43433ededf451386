// Rows by the format's own planes; compression by zlib.
#include "firmware-host/session/picture_bytes.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <zlib.h>

namespace orcart {
namespace {

std::byte less(std::byte a, std::byte b) {
  return static_cast<std::byte>(std::to_integer<unsigned>(a) - std::to_integer<unsigned>(b));
}
std::byte plus(std::byte a, std::byte b) {
  return static_cast<std::byte>(std::to_integer<unsigned>(a) + std::to_integer<unsigned>(b));
}
std::byte before(std::span<const std::byte> bytes, std::size_t i) {
  return i < 4 ? std::byte{0} : bytes[i - 4];
}

}  // namespace

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
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL, Z_HUFFMAN_ONLY);
  buffer.resize(deflateBound(&stream, bytes.size()));
  stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
  stream.avail_out = static_cast<uInt>(buffer.size());
  std::array<std::byte, 16384> part;
  for (std::size_t from = 0; from < bytes.size(); from += part.size()) {
    const std::size_t count = std::min(part.size(), bytes.size() - from);
    for (std::size_t i = 0; i < count; ++i) part[i] = less(bytes[from + i], before(bytes, from + i));
    stream.next_in = reinterpret_cast<Bytef*>(part.data());
    stream.avail_in = static_cast<uInt>(count);
    deflate(&stream, Z_NO_FLUSH);  // cannot fail: the buffer has room for the worst case
  }
  deflate(&stream, Z_FINISH);
  const std::size_t size = stream.total_out;
  deflateEnd(&stream);
  return std::span(buffer).first(size);
}

Result<std::vector<std::byte>> inflated(std::span<const std::byte> bytes, std::size_t size_bytes) {
  std::vector<std::byte> unfolded(size_bytes);
  uLongf size = size_bytes;
  const int code = uncompress(reinterpret_cast<Bytef*>(unfolded.data()), &size,
                              reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (code != Z_OK || size != size_bytes)
    return fail("a picture of " + std::to_string(size_bytes) + " bytes is damaged and was not read");
  for (std::size_t i = 4; i < size_bytes; ++i) unfolded[i] = plus(unfolded[i], unfolded[i - 4]);
  return unfolded;
}

}  // namespace orcart
