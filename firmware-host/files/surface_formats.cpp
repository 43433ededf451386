// What the surface formats share: the words in comments, and polygons.
#include "firmware-host/files/surface_formats.hpp"

#include <algorithm>

#include "firmware-host/files/text_cursor.hpp"

namespace orcart {

void take_comment(std::string_view comment, ParsedSurface& surface) {
  constexpr std::string_view kSpace = "SPACE=";
  if (const auto at = comment.find(kSpace); at != std::string_view::npos) {
    const std::string_view rest = comment.substr(at + kSpace.size());
    const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
    const auto end = std::find_if_not(rest.begin(), rest.end(), is_letter);
    surface.space.emplace(rest.begin(), end);
  }
  TextCursor words(comment);
  if (words.word() != "orcart") return;
  const std::string_view key = words.word();
  std::string_view value = comment.substr(words.place());
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  if (key == "hash") surface.stated.hash = value;
  if (key == "series") surface.stated.series = value;
  if (key == "frame_of_reference") surface.stated.frame_of_reference = value;
}

bool append_polygon(std::span<const std::uint32_t> corners, std::size_t vertex_count, TriangleMesh& mesh) {
  if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t i) { return i >= vertex_count; }))
    return false;
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  return true;
}

}  // namespace orcart
