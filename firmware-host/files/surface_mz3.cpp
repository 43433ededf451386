// mz3 (Rorden, Surf Ice, "MZ3 file format"): gzip over a 16-byte header, triangles and vertices.
#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "firmware-host/files/surface_formats.hpp"

namespace orcart {

namespace {

struct Mz3Header {
  std::uint16_t magic = 0, holds = 0;
  std::uint32_t faces = 0, vertices = 0, skip_bytes = 0;
};
static_assert(sizeof(Mz3Header) == 16);

constexpr std::uint16_t kMagic = 0x5A4D;
constexpr unsigned kFaces = 1, kVertices = 2;

/// Both plain and gzipped files exist.
std::vector<std::byte> unpacked(std::span<const std::byte> bytes, std::size_t most_bytes) {
  if (bytes.size() < 2 || bytes[0] != std::byte{0x1F} || bytes[1] != std::byte{0x8B})
    return {bytes.begin(), bytes.end()};
  std::vector<std::byte> plain;
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) return plain;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  int status = Z_OK;
  while (status == Z_OK && plain.size() < most_bytes) {
    constexpr std::size_t kPiece = std::size_t{1} << 22U;
    const std::size_t at = plain.size();
    plain.resize(at + kPiece);
    stream.next_out = reinterpret_cast<Bytef*>(plain.data() + at);
    stream.avail_out = static_cast<uInt>(kPiece);
    status = inflate(&stream, Z_NO_FLUSH);
    plain.resize(at + kPiece - stream.avail_out);
  }
  inflateEnd(&stream);
  return plain;
}

}  // namespace

Result<ParsedSurface> parse_mz3(std::span<const std::byte> bytes, const std::string& name) {
  constexpr std::size_t kRecordBytes = 12, kMostBytes = std::size_t{1} << 29U;
  const std::vector<std::byte> plain = unpacked(bytes, kMostBytes);
  Mz3Header header;
  if (plain.size() < sizeof header) return fail(name + ": is no mz3, or is damaged; a whole one is expected");
  std::memcpy(&header, plain.data(), sizeof header);
  if (header.magic != kMagic || (header.holds & (kFaces | kVertices)) != (kFaces | kVertices))
    return fail(name + ": does not begin as an mz3 with triangles and vertices; one is expected");
  if (header.faces > kLargestTriangleCount || header.vertices > kLargestVertexCount)
    return fail(name + ": says " + std::to_string(header.faces) + " triangles and " +
                std::to_string(header.vertices) + " vertices; up to " +
                std::to_string(kLargestTriangleCount) + " and " + std::to_string(kLargestVertexCount) +
                " are accepted");
  const std::size_t faces_at = sizeof header + std::size_t{header.skip_bytes};
  const std::size_t vertices_at = faces_at + kRecordBytes * header.faces;
  if (plain.size() < vertices_at + kRecordBytes * header.vertices)
    return fail(name + ": holds fewer bytes than its " + std::to_string(header.faces) +
                " triangles take; it is cut short");
  ParsedSurface surface;
  surface.mesh.triangles.resize(header.faces);
  surface.mesh.vertices_mm.resize(header.vertices);
  for (std::size_t t = 0; t < header.faces; ++t)
    std::memcpy(surface.mesh.triangles[t].data(), plain.data() + faces_at + kRecordBytes * t, kRecordBytes);
  for (std::size_t v = 0; v < header.vertices; ++v)
    std::memcpy(surface.mesh.vertices_mm[v].data(), plain.data() + vertices_at + kRecordBytes * v,
                kRecordBytes);
  for (std::size_t t = 0; t < header.faces; ++t)
    for (const std::uint32_t corner : surface.mesh.triangles[t])
      if (corner >= header.vertices)
        return fail(name + ": triangle " + std::to_string(t) + " has vertex " + std::to_string(corner) +
                    "; 0 to " + std::to_string(header.vertices) + " less one are accepted");
  return surface;
}

}  // namespace orcart
