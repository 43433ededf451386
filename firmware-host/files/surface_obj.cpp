// Wavefront OBJ: vertices and faces of any number of corners; texture, normals and materials are passed over.
#include <vector>

#include "firmware-host/files/surface_formats.hpp"
#include "firmware-host/files/text_cursor.hpp"

namespace orcart {

namespace {

/// The vertex of a corner `v`, `v/t`, `v//n` or `v/t/n`; negative ones count back from the last. Nothing
/// where it is wrong.
std::optional<std::uint32_t> vertex_of(std::string_view corner, std::size_t vertex_count) {
  const auto number = TextCursor::parse_number<std::int64_t>(corner.substr(0, corner.find('/')));
  if (!number) return std::nullopt;
  const auto count = static_cast<std::int64_t>(vertex_count);
  if (*number < -count || *number > count || *number == 0) return std::nullopt;
  return static_cast<std::uint32_t>(*number > 0 ? *number - 1 : count + *number);
}

/// The next line, with those behind it that a backslash at the end joins to it.
std::string_view whole_line(TextCursor& lines, std::string& joined) {
  std::string_view line = lines.line();
  if (!line.ends_with('\\')) return line;
  joined.clear();
  while (line.ends_with('\\')) {
    joined.append(line.substr(0, line.size() - 1)) += ' ';
    line = lines.line();
  }
  return joined.append(line);
}

}  // namespace

Result<ParsedSurface> parse_obj(std::span<const std::byte> bytes, const std::string& name) {
  ParsedSurface surface;
  TextCursor lines({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  std::vector<std::uint32_t> corners;
  std::string joined;
  while (!lines.at_end()) {
    const std::string_view line = whole_line(lines, joined);
    TextCursor words(line);
    const std::string_view key = words.word();
    const auto wrong = [&](const std::string& expected) {
      std::string sentence = name + ":" + std::to_string(lines.line_number()) + ": \"";
      return fail(sentence.append(line.substr(0, 60)).append("\"; ").append(expected));
    };
    if (key.starts_with('#')) take_comment(line.substr(line.find('#') + 1), surface);
    if (key == "v") {
      const auto x = words.number<float>(), y = words.number<float>(), z = words.number<float>();
      if (!x || !y || !z) return wrong("`v X Y Z` is expected");
      if (surface.mesh.vertices_mm.size() == kLargestVertexCount)
        return wrong("12000000 vertices are the most accepted");
      surface.mesh.vertices_mm.emplace_back(*x, *y, *z);
    }
    if (key != "f") continue;
    corners.clear();
    for (std::string_view corner = words.word(); !corner.empty(); corner = words.word()) {
      const auto vertex = vertex_of(corner, surface.mesh.vertices_mm.size());
      if (!vertex)
        return wrong("corners from 1 to " + std::to_string(surface.mesh.vertices_mm.size()) +
                     ", the vertices before " + "this line, are accepted");
      corners.push_back(*vertex);
    }
    if (corners.empty()) return wrong("a face of 3 or more corners is expected");
    if (corners.size() < 3)
      corners.resize(3, corners.front());  // without area: dropped and told with the others
    append_polygon(corners, surface.mesh.vertices_mm.size(), surface.mesh);
    if (surface.mesh.triangles.size() > kLargestTriangleCount)
      return wrong(std::to_string(kLargestTriangleCount) + " triangles are the most accepted");
  }
  return surface;
}

}  // namespace orcart
