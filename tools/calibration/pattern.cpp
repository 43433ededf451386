// Reads a pattern's description; every refusal names the part that is wrong.
#include "tools/calibration/pattern.hpp"

#include <array>
#include <cstdio>
#include <optional>
#include <vector>

#include "firmware-host/files/text_cursor.hpp"

namespace orcart {
namespace {

constexpr const char* kAccepted =
    "chessboard:14x10:3mm, charuco:19x26:5mm:4mm:4X4_250[:legacy] or dots:16x14:4mm is accepted";

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(at);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<double> length_mm(std::string_view text) {
  if (!text.ends_with("mm")) return std::nullopt;
  const auto number = TextCursor::parse_number<double>(text.substr(0, text.size() - 2));
  if (!number || !(*number >= 0.01 && *number <= 1000)) return std::nullopt;
  return number;
}

tl::unexpected<Error> refuse(std::string_view pattern, std::string_view part, const std::string& wanted) {
  return fail("--pattern " + std::string(pattern) + ": \"" + std::string(part) + "\" is no " + wanted + "; " +
              kAccepted);
}

/// "14x10".
bool read_size(std::string_view text, Pattern& pattern) {
  const auto sides = split(text, 'x');
  if (sides.size() != 2) return false;
  const auto columns = TextCursor::parse_number<int>(sides[0]),
             rows = TextCursor::parse_number<int>(sides[1]);
  if (!columns || !rows || *columns < 3 || *rows < 3 || *columns > 200 || *rows > 200) return false;
  pattern.columns = *columns;
  pattern.rows = *rows;
  return true;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// The parts after the spacing: marker, dictionary, layout.
Result<Pattern> with_markers(Pattern pattern, std::string_view text,
                             const std::vector<std::string_view>& parts) {
  const auto marker = length_mm(parts[3]);
  if (!marker || *marker >= pattern.spacing_mm)
    return refuse(text, parts[3], "marker side in mm below the square's");
  pattern.marker_mm = *marker;
  pattern.dictionary = parts[4];
  if (parts.size() == 6 && parts[5] != "legacy") return refuse(text, parts[5], "layout");
  pattern.legacy_first = parts.size() == 6;
  return pattern;
}

}  // namespace

Result<Pattern> parse_pattern(std::string_view text) {
  const auto parts = split(text, ':');
  Pattern pattern;
  if (parts[0] == "charuco") {
    pattern.kind = PatternKind::charuco;
  } else if (parts[0] == "dots") {
    pattern.kind = PatternKind::dots;
  } else if (parts[0] != "chessboard") {
    return refuse(text, parts[0], "kind of pattern");
  }
  const bool charuco = pattern.kind == PatternKind::charuco;
  if (charuco ? parts.size() < 5 || parts.size() > 6 : parts.size() != 3)
    return refuse(text, text, "whole description");
  if (!read_size(parts[1], pattern)) return refuse(text, parts[1], "size of 3x3 to 200x200");
  const auto spacing = length_mm(parts[2]);
  if (!spacing) return refuse(text, parts[2], "length in mm from 0.01mm to 1000mm");
  pattern.spacing_mm = *spacing;
  return charuco ? with_markers(pattern, text, parts) : pattern;
}

std::string text_of(const Pattern& pattern) {
  const std::string size = std::to_string(pattern.columns) + "x" + std::to_string(pattern.rows) + ":" +
                           number(pattern.spacing_mm) + "mm";
  if (pattern.kind == PatternKind::chessboard) return "chessboard:" + size;
  if (pattern.kind == PatternKind::dots) return "dots:" + size;
  return "charuco:" + size + ":" + number(pattern.marker_mm) + "mm:" + pattern.dictionary +
         (pattern.legacy_first ? ":legacy" : "");
}

}  // namespace orcart
