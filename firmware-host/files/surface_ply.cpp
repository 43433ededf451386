// PLY (Turk 1994): ascii and binary of either byte order, any order of properties, unknown ones skipped.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>

#include "firmware-host/files/surface_formats.hpp"
#include "firmware-host/files/text_cursor.hpp"

namespace orcart {

namespace {

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Encoding { ascii, little, big };

struct Property {
  std::string name;
  Scalar type = Scalar::f32;
  std::optional<Scalar> count_type;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::size_t body_at = 0;
  std::size_t line_count = 0;
};

std::optional<Scalar> scalar_of(std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                   {"uchar", "uint8"},
                                                                   {"short", "int16"},
                                                                   {"ushort", "uint16"},
                                                                   {"int", "int32"},
                                                                   {"uint", "uint32"},
                                                                   {"float", "float32"},
                                                                   {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<Scalar>(i);
  return std::nullopt;
}

std::size_t bytes_of(Scalar type) {
  constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

std::string plain(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.12g", number);
  return text.data();
}

/// One line of the header into `header`; what is wrong with it, or nothing.
std::optional<std::string> take_header_line(std::string_view line, Header& header, ParsedSurface& surface) {
  TextCursor words(line);
  const std::string_view key = words.word();
  if (key == "comment" || key == "obj_info") {
    std::string_view comment = line.substr(words.place());
    if (!comment.empty()) comment.remove_prefix(1);
    take_comment(comment, surface);
  } else if (key == "format") {
    const std::string_view word = words.word();
    if (word == "ascii")
      header.encoding = Encoding::ascii;
    else if (word == "binary_little_endian")
      header.encoding = Encoding::little;
    else if (word == "binary_big_endian")
      header.encoding = Encoding::big;
    else
      return "ascii, binary_little_endian or binary_big_endian is accepted";
  } else if (key == "element") {
    Element element{.name = std::string(words.word()), .count = 0, .properties = {}};
    const auto count = words.number<std::uint64_t>();
    if (!count) return "`element NAME COUNT` is expected";
    element.count = *count;
    header.elements.push_back(std::move(element));
  } else if (key == "property") {
    if (header.elements.empty()) return "an element is expected before its properties";
    Property property;
    std::string_view word = words.word();
    if (word == "list") {
      property.count_type = scalar_of(words.word());
      if (!property.count_type || *property.count_type >= Scalar::f32)
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

/// Reads scalars of the body, one by one, in any of the three encodings.
class Body {
 public:
  Body(std::string_view body, Encoding encoding)
      : body_(body), encoding_(encoding), text_(encoding == Encoding::ascii ? body : std::string_view{}) {}

  std::size_t left() const {
    return encoding_ == Encoding::ascii ? body_.size() - text_.place() : body_.size() - at_;
  }
  std::size_t line_number() const { return text_.line_number(); }
  bool ascii() const { return encoding_ == Encoding::ascii; }

  std::optional<double> next(Scalar type) {
    if (encoding_ == Encoding::ascii) return text_.number<double>();
    switch (type) {
      case Scalar::i8:
        return take<std::int8_t>();
      case Scalar::u8:
        return take<std::uint8_t>();
      case Scalar::i16:
        return take<std::int16_t>();
      case Scalar::u16:
        return take<std::uint16_t>();
      case Scalar::i32:
        return take<std::int32_t>();
      case Scalar::u32:
        return take<std::uint32_t>();
      case Scalar::f32:
        return take<float>();
      case Scalar::f64:
        return take<double>();
    }
    return std::nullopt;
  }

 private:
  template <class Number>
  std::optional<double> take() {
    std::array<char, sizeof(Number)> raw{};
    if (body_.size() - at_ < raw.size()) return std::nullopt;
    std::memcpy(raw.data(), body_.data() + at_, raw.size());
    at_ += raw.size();
    if ((encoding_ == Encoding::big) == (std::endian::native == std::endian::little))
      std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<Number>(raw));
  }

  std::string_view body_;
  Encoding encoding_;
  TextCursor text_;
  std::size_t at_ = 0;
};

class PlyParser {
 public:
  PlyParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Result<ParsedSurface> parse() {
    if (auto header = read_header(); !header) return tl::unexpected(header.error());
    Body body(text_.substr(header_.body_at), header_.encoding);
    for (const Element& element : header_.elements) {
      if (auto read = read_element(element, body); !read) return tl::unexpected(read.error());
    }
    return std::move(surface_);
  }

 private:
  Result<void> read_header() {
    TextCursor lines(text_);
    if (lines.line() != "ply")
      return fail(name_ + ": does not begin with the line `ply`; a PLY file is expected");
    while (!lines.at_end()) {
      const std::string_view line = lines.line();
      header_.line_count = lines.line_number();
      if (line == "end_header") {
        header_.body_at = lines.place();
        return {};
      }
      if (const auto wrong = take_header_line(line, header_, surface_))
        return fail(name_ + ":" + std::to_string(lines.line_number()) + ": \"" +
                    std::string(line.substr(0, 60)) + "\" in the header; " + *wrong);
    }
    return fail(name_ + ": has no end_header; the file is cut short or not a PLY");
  }

  /// The fewest bytes one record can take, so that a count can be held against what is left of the file.
  std::size_t least_bytes(const Element& element) const {
    std::size_t bytes = 0;
    for (const Property& property : element.properties) {
      if (header_.encoding == Encoding::ascii)
        bytes += 1;
      else
        bytes += bytes_of(property.count_type.value_or(property.type));
    }
    return bytes;
  }

  Result<void> read_element(const Element& element, Body& body) {
    const std::size_t least = least_bytes(element);
    const std::string said =
        "its header says " + std::to_string(element.count) + " of element " + element.name;
    const bool faces = element.name == "face", vertices = element.name == "vertex";
    const std::size_t most = faces ? kLargestTriangleCount : kLargestVertexCount;
    if ((faces || vertices) && element.count > most)
      return fail(name_ + ": " + said + "; up to " + std::to_string(most) + " are accepted");
    if (least == 0) return {};
    if (element.count > body.left() / least + 1)
      return fail(name_ + ": " + said + ", but only " + std::to_string(body.left()) +
                  " bytes follow; the file is cut short");
    if (vertices) return read_vertices(element, body);
    if (faces) return read_faces(element, body);
    return skip(element, body);
  }

  Result<void> cut_short(const Element& element, std::uint64_t record, const Body& body) const {
    if (body.ascii() && body.left() > 0)
      return fail(name_ + ":" + std::to_string(header_.line_count + body.line_number() + 1) + ": " +
                  element.name + " " + std::to_string(record) +
                  " holds a word that is no number; a number is expected");
    return fail(name_ + ": ends within " + element.name + " " + std::to_string(record) + " of " +
                std::to_string(element.count) + "; the file is cut short");
  }

  static bool skip_property(const Property& property, Body& body) {
    double count = 1;
    if (property.count_type) {
      const auto said = body.next(*property.count_type);
      if (!said || !(*said >= 0) || *said > static_cast<double>(body.left())) return false;
      count = *said;
    }
    for (double i = 0; i < count; ++i)
      if (!body.next(property.type)) return false;
    return true;
  }

  Result<void> skip(const Element& element, Body& body) {
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const Property& property : element.properties)
        if (!skip_property(property, body)) return cut_short(element, i, body);
    return {};
  }

  Result<void> read_vertices(const Element& element, Body& body) {
    std::vector<int> axis_of;
    int axes = 0;
    for (const Property& property : element.properties) {
      const int axis = property.count_type || property.name.size() != 1 ? -1 : property.name[0] - 'x';
      axis_of.push_back(axis >= 0 && axis < 3 ? axis : -1);
      if (axis_of.back() >= 0) axes |= 1 << axis;
    }
    if (axes != 7) return fail(name_ + ": its vertices lack x, y or z; all three are expected");
    surface_.mesh.vertices_mm.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Eigen::Vector3f vertex = Eigen::Vector3f::Zero();
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (axis_of[p] < 0) {
          if (!skip_property(property, body)) return cut_short(element, i, body);
          continue;
        }
        const auto value = body.next(property.type);
        if (!value) return cut_short(element, i, body);
        vertex[axis_of[p]] = static_cast<float>(*value);
      }
      surface_.mesh.vertices_mm.push_back(vertex);
    }
    return {};
  }

  Result<void> read_faces(const Element& element, Body& body) {
    const auto is_corners = [](const Property& p) {
      return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_corners))
      return fail(name_ + ": its faces lack the list vertex_indices; it is expected");
    surface_.mesh.triangles.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (!is_corners(property)) {
          if (!skip_property(property, body)) return cut_short(element, i, body);
        } else if (auto read = read_corners(element, i, property, body); !read) {
          return read;
        }
      }
    }
    return {};
  }

  Result<void> read_corners(const Element& element, std::uint64_t face, const Property& property,
                            Body& body) {
    const auto count = body.next(*property.count_type);
    if (!count) return cut_short(element, face, body);
    if (!(*count >= 3 && *count <= kLargestPolygon))
      return fail(name_ + ": face " + std::to_string(face) + " has " + plain(*count) + " corners; 3 to " +
                  std::to_string(kLargestPolygon) + " are accepted");
    corners_.clear();
    for (int i = 0; i < static_cast<int>(*count); ++i) {
      const auto index = body.next(property.type);
      if (!index) return cut_short(element, face, body);
      const std::size_t vertices = surface_.mesh.vertices_mm.size();
      if (!(*index >= 0 && *index < static_cast<double>(vertices) && std::floor(*index) == *index))
        return fail(name_ + ": face " + std::to_string(face) + " has vertex " + plain(*index) +
                    "; whole numbers below " + std::to_string(vertices) + " are accepted");
      corners_.push_back(static_cast<std::uint32_t>(*index));
    }
    append_polygon(corners_, surface_.mesh.vertices_mm.size(), surface_.mesh);
    if (surface_.mesh.triangles.size() > kLargestTriangleCount)
      return fail(name_ + ": has more than " + std::to_string(kLargestTriangleCount) +
                  " triangles; up to that many are accepted");
    return {};
  }

  static constexpr int kLargestPolygon = 255;
  std::string_view text_;
  const std::string& name_;
  Header header_;
  ParsedSurface surface_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<ParsedSurface> parse_ply(std::span<const std::byte> bytes, const std::string& name) {
  return PlyParser({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name).parse();
}

}  // namespace orcart
