// Reads the lines of a PLY header one by one.
#include "firmware-host/files/ply_header.hpp"

#include <array>

#include "firmware-host/files/text_cursor.hpp"

namespace orcart {

namespace {

std::optional<PlyScalar> scalar_of(std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                   {"uchar", "uint8"},
                                                                   {"short", "int16"},
                                                                   {"ushort", "uint16"},
                                                                   {"int", "int32"},
                                                                   {"uint", "uint32"},
                                                                   {"float", "float32"},
                                                                   {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<PlyScalar>(i);
  return std::nullopt;
}

/// One line of the header into `header`; what is wrong with it, or nothing.
std::optional<std::string> take_header_line(std::string_view line, PlyHeader& header,
                                            ParsedSurface& surface) {
  TextCursor words(line);
  const std::string_view key = words.word();
  if (key == "comment" || key == "obj_info") {
    std::string_view comment = line.substr(words.place());
    if (!comment.empty()) comment.remove_prefix(1);
    take_comment(comment, surface);
  } else if (key == "format") {
    const std::string_view word = words.word();
    if (word == "ascii")
      header.encoding = PlyEncoding::ascii;
    else if (word == "binary_little_endian")
      header.encoding = PlyEncoding::little;
    else if (word == "binary_big_endian")
      header.encoding = PlyEncoding::big;
    else
      return "ascii, binary_little_endian or binary_big_endian is accepted";
  } else if (key == "element") {
    PlyElement element{.name = std::string(words.word()), .count = 0, .properties = {}};
    const auto count = words.number<std::uint64_t>();
    if (!count) return "`element NAME COUNT` is expected";
    element.count = *count;
    header.elements.push_back(std::move(element));
  } else if (key == "property") {
    if (header.elements.empty()) return "an element is expected before its properties";
    PlyProperty property;
    std::string_view word = words.word();
    if (word == "list") {
      property.count_type = scalar_of(words.word());
      if (!property.count_type || *property.count_type >= PlyScalar::f32)
        return "a list's count needs a whole type";
      word = words.word();
    }
    const auto type = scalar_of(word);
    if (!type) return "a type such as float, double, uchar or int is expected";
    property.type = *type;
    property.name = words.word();
    header.elements.back().properties.push_back(std::move(property));
  } else if (!key.empty()) {
    return "format, element, property, comment or end_header is expected";
  }
  return std::nullopt;
}

}  // namespace

Result<PlyHeader> read_ply_header(std::string_view text, const std::string& name, ParsedSurface& surface) {
  PlyHeader header;
  TextCursor lines(text);
  if (lines.line() != "ply")
    return fail(name + ": does not begin with the line `ply`; a PLY file is expected");
  while (!lines.at_end()) {
    const std::string_view line = lines.line();
    header.line_count = lines.line_number();
    if (line == "end_header") {
      header.body_at = lines.place();
      return header;
    }
    if (const auto wrong = take_header_line(line, header, surface))
      return fail(name + ":" + std::to_string(lines.line_number()) + ": \"" +
                  std::string(line.substr(0, 60)) + "\" in the header; " + *wrong);
  }
  return fail(name + ": has no end_header; the file is cut short or not a PLY");
}

std::size_t bytes_of(PlyScalar type) {
  constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

std::size_t least_bytes(const PlyElement& element, PlyEncoding encoding) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += encoding == PlyEncoding::ascii ? 1 : bytes_of(property.count_type.value_or(property.type));
  return bytes;
}

}  // namespace orcart
