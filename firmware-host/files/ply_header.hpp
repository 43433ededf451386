// The header of a PLY file: which elements follow, with which properties, in which encoding.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/files/surface_formats.hpp"

namespace orcart {

enum class PlyScalar { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class PlyEncoding { ascii, little, big };

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::f32;
  std::optional<PlyScalar> count_type;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t body_at = 0;
  std::size_t line_count = 0;
};

/// Reads up to end_header; what comments say goes into `surface`. Errors name the line.
Result<PlyHeader> read_ply_header(std::string_view text, const std::string& name, ParsedSurface& surface);

std::size_t bytes_of(PlyScalar type);

/// The fewest bytes one record can take, so that a count can be held against what is left of the file.
std::size_t least_bytes(const PlyElement& element, PlyEncoding encoding);

}  // namespace orcart
