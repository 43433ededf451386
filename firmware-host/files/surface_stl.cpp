// STL: binary and ascii. Its triangles repeat their vertices; equal ones are merged exactly, in the order
// first seen.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>

#include "firmware-host/files/surface_formats.hpp"
#include "firmware-host/files/text_cursor.hpp"
#include "firmware-host/files/vertex_merger.hpp"

namespace orcart {

namespace {

constexpr std::size_t kHeaderBytes = 84, kTriangleBytes = 50;

Result<ParsedSurface> parse_binary(std::span<const std::byte> bytes, std::uint32_t count) {
  ParsedSurface surface;
  take_comment({reinterpret_cast<const char*>(bytes.data()), 80}, surface);
  VertexMerger merger(surface.mesh);
  surface.mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 12> numbers{};  // the normal, then three corners
    std::memcpy(numbers.data(), bytes.data() + kHeaderBytes + i * kTriangleBytes, sizeof numbers);
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner)
      triangle[corner] = merger.index_of(Eigen::Vector3f(numbers.data() + 3 + 3 * corner));
    surface.mesh.triangles.push_back(triangle);
  }
  return surface;
}

/// A key in lower case: some CAD programs write all of a file in capitals.
std::string key_of(TextCursor& words) {
  std::string key(words.word());
  std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return std::tolower(c); });
  return key;
}

Result<ParsedSurface> parse_ascii(std::string_view text, const std::string& name) {
  ParsedSurface surface;
  VertexMerger merger(surface.mesh);
  TextCursor lines(text);
  std::array<std::uint32_t, 3> triangle{};
  std::size_t corner = 0;
  bool ended = false;
  while (!lines.at_end()) {
    const std::string_view line = lines.line();
    TextCursor words(line);
    const std::string key = key_of(words);
    const auto place = [&] { return name + ":" + std::to_string(lines.line_number()) + ": "; };
    if (key == "solid") take_comment(line, surface);
    ended = key == "endsolid" || (ended && key.empty());
    if (key == "endfacet") {
      if (corner != 3)
        return fail(place() + "a facet has " + std::to_string(corner) + " vertices; 3 are expected");
      if (surface.mesh.triangles.size() == kLargestTriangleCount)
        return fail(name + ": has more than " + std::to_string(kLargestTriangleCount) +
                    " triangles; up to that many are accepted");
      surface.mesh.triangles.push_back(triangle);
      corner = 0;
    }
    if (key != "vertex") continue;
    const auto x = words.number<float>(), y = words.number<float>(), z = words.number<float>();
    if (!x || !y || !z)
      return fail(place() + "\"" + std::string(line.substr(0, 60)) + "\"; `vertex X Y Z` is expected");
    if (corner == 3) return fail(place() + "a facet has more than 3 vertices; 3 are expected");
    triangle[corner++] = merger.index_of({*x, *y, *z});
  }
  if (!ended) return fail(name + ": has no endsolid at its end; the file is cut short");
  return surface;
}

}  // namespace

Result<ParsedSurface> parse_stl(std::span<const std::byte> bytes, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::uint32_t count = 0;
  if (bytes.size() >= kHeaderBytes)
    std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof count, sizeof count);
  const bool fits = bytes.size() >= kHeaderBytes && bytes.size() == kHeaderBytes + count * kTriangleBytes;
  TextCursor words(text.substr(0, kHeaderBytes));
  if (!fits && key_of(words) == "solid") return parse_ascii(text, name);
  if (bytes.size() < kHeaderBytes)
    return fail(name + ": is " + std::to_string(bytes.size()) +
                " bytes long; an STL file of 84 or more is expected");
  if (count > kLargestTriangleCount)
    return fail(name + ": its header says " + std::to_string(count) + " triangles; up to " +
                std::to_string(kLargestTriangleCount) + " are accepted");
  if (!fits)
    return fail(name + ": its header says " + std::to_string(count) + " triangles, which take " +
                std::to_string(kHeaderBytes + count * kTriangleBytes) + " bytes, but it is " +
                std::to_string(bytes.size()) + " bytes long; the file is damaged or no STL");
  return parse_binary(bytes, count);
}

}  // namespace orcart
