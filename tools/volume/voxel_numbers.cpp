// Numbers of any width and byte order, and zlib.
#include "tools/volume/voxel_numbers.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "firmware-host/files/whole_file.hpp"

namespace orcart {

namespace {

template <class Number>
void append(std::span<const std::byte> bytes, const VoxelEncoding& encoding, std::vector<float>& values) {
  const std::size_t count = bytes.size() / sizeof(Number), first = values.size();
  const bool swapped = encoding.big_endian == (std::endian::native == std::endian::little);
  values.resize(first + count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::byte, sizeof(Number)> raw;
    std::memcpy(raw.data(), bytes.data() + i * sizeof(Number), sizeof(Number));
    if (swapped) std::reverse(raw.begin(), raw.end());
    values[first + i] = static_cast<float>(static_cast<double>(std::bit_cast<Number>(raw)) * encoding.slope +
                                           encoding.intercept);
  }
}

}  // namespace

std::size_t bytes_of(VoxelType type) {
  constexpr std::array<std::size_t, 10> kBytes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

const char* name_of(VoxelType type) {
  constexpr std::array<const char*, 10> kNames{"uint8", "int8",   "uint16", "int16",   "uint32",
                                               "int32", "uint64", "int64",  "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

void append_numbers(std::span<const std::byte> bytes, const VoxelEncoding& encoding,
                    std::vector<float>& values) {
  using Append = void (*)(std::span<const std::byte>, const VoxelEncoding&, std::vector<float>&);
  constexpr std::array<Append, 10> kAppend{
      append<std::uint8_t>,  append<std::int8_t>,  append<std::uint16_t>, append<std::int16_t>,
      append<std::uint32_t>, append<std::int32_t>, append<std::uint64_t>, append<std::int64_t>,
      append<float>,         append<double>};
  kAppend[static_cast<std::size_t>(encoding.type)](bytes, encoding, values);
}

bool is_gzip(std::span<const std::byte> bytes) {
  return bytes.size() > 2 && bytes[0] == std::byte{0x1F} && bytes[1] == std::byte{0x8B};
}

std::vector<std::byte> inflate(std::span<const std::byte> packed, std::uint64_t enough) {
  constexpr int kEitherHeader = 15 + 32;
  constexpr std::size_t kPiece = std::size_t{1} << 24U;
  std::vector<std::byte> plain;
  z_stream stream{};
  if (inflateInit2(&stream, kEitherHeader) != Z_OK) return plain;
  std::size_t taken = 0;
  int status = Z_OK;
  while (status == Z_OK && plain.size() < enough) {
    const std::size_t at = plain.size(), room = std::min<std::uint64_t>(kPiece, enough - at);
    const std::size_t piece = std::min(kPiece, packed.size() - taken);
    plain.resize(at + room);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data() + taken));
    stream.avail_in = static_cast<uInt>(piece);
    stream.next_out = reinterpret_cast<Bytef*>(plain.data() + at);
    stream.avail_out = static_cast<uInt>(room);
    status = ::inflate(&stream, Z_NO_FLUSH);
    taken += piece - stream.avail_in;
    plain.resize(at + room - stream.avail_out);
    if (status == Z_BUF_ERROR && plain.size() > at) status = Z_OK;
    const bool another = status == Z_STREAM_END && is_gzip(packed.subspan(taken));  // files may be joined
    if (another) status = inflateReset(&stream);
  }
  inflateEnd(&stream);
  return plain;
}

Result<std::vector<std::byte>> read_plain(const std::filesystem::path& file) {
  auto bytes = read_whole_file(file, kMostVolumeBytes);
  if (!bytes || !is_gzip(*bytes)) return bytes;
  auto plain = inflate(*bytes, kMostVolumeBytes);
  if (plain.empty()) return fail(file.string() + ": begins as a gzip but cannot be unpacked; it is damaged");
  return plain;
}

}  // namespace orcart
