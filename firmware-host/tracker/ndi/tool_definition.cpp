// Reads and checks .rom files.
#include "firmware-host/tracker/ndi/tool_definition.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

#include "firmware-host/tracker/ndi/byte_cursor.hpp"

namespace orcart::ndi {
namespace {

// Where things are, decoded from files of NDI and others.
constexpr std::size_t kChecksumAt = 4;
constexpr std::size_t kSummedFrom = 6;
constexpr std::size_t kMainTypeAt = 15;
constexpr std::size_t kSerialNumberAt = 20;
constexpr std::size_t kMaxAngleAt = 24;
constexpr std::size_t kMarkerCountAt = 28;
constexpr std::size_t kNeededMarkersAt = 32;
constexpr std::size_t kMaxErrorAt = 36;
constexpr std::size_t kMarkersAt = 72;
constexpr std::size_t kManufacturerAt = 580;
constexpr std::size_t kManufacturerBytes = 12;
constexpr std::size_t kPartNumberAt = 592;
constexpr std::size_t kPartNumberBytes = 20;

using Bytes = std::span<const std::byte>;

ByteCursor at(Bytes bytes, std::size_t offset) {
  return ByteCursor{bytes.subspan(offset)};
}

/// Up to the first zero; what is not printable is left out.
std::string text_at(Bytes bytes, std::size_t offset, std::size_t size) {
  std::string text;
  for (const std::byte byte : bytes.subspan(offset, size)) {
    const auto letter = std::to_integer<char>(byte);
    if (letter == '\0') break;
    if (letter >= ' ' && letter <= '~') text += letter;
  }
  return text;
}

std::uint16_t checksum_of(Bytes bytes) {
  std::uint32_t sum = 0;
  for (const std::byte byte : bytes.subspan(kSummedFrom)) sum += std::to_integer<std::uint32_t>(byte);
  return static_cast<std::uint16_t>(sum);
}

std::string four_digits(unsigned value) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%04X", value & 0xFFFFu);
  return text.data();
}

/// What keeps the bytes from being a definition; empty where nothing does.
std::string objection(Bytes bytes) {
  if (bytes.size() != kRomFileBytes) {
    return "has " + std::to_string(bytes.size()) + " bytes; a tool definition has " +
           std::to_string(kRomFileBytes);
  }
  if (text_at(bytes, 0, 4) != "NDI") return "does not begin with NDI; a tool definition (.rom) is wanted";
  const unsigned stated = at(bytes, kChecksumAt).u16();
  const unsigned found = checksum_of(bytes);
  if (stated != found) {
    return "is damaged: it states the checksum " + four_digits(stated) + ", its bytes add up to " +
           four_digits(found);
  }
  const std::uint32_t markers = at(bytes, kMarkerCountAt).u32();
  if (markers < 3 || markers > ToolDefinition::kMaxMarkers) {
    return "has " + std::to_string(markers) + " markers; 3 to " +
           std::to_string(ToolDefinition::kMaxMarkers) + " can be tracked";
  }
  return {};
}

/// False where a position is no number.
bool read_markers(Bytes bytes, ToolDefinition& tool) {
  ByteCursor cursor = at(bytes, kMarkersAt);
  bool finite = true;
  for (int i = 0; i < tool.marker_count; ++i) {
    for (float& part : tool.markers_mm[static_cast<std::size_t>(i)]) {
      part = cursor.f32();
      finite = finite && std::isfinite(part);
    }
  }
  return finite;
}

}  // namespace

Result<ToolDefinition> parse_tool_definition(Bytes bytes, std::string_view name) {
  const std::string subject = "tool definition " + std::string(name) + " ";
  if (const std::string why = objection(bytes); !why.empty()) return fail(subject + why);
  ToolDefinition tool;
  std::copy(bytes.begin(), bytes.end(), tool.memory.begin());
  tool.main_type = at(bytes, kMainTypeAt).u8();
  tool.serial_number = at(bytes, kSerialNumberAt).u32();
  tool.max_angle_deg = static_cast<int>(at(bytes, kMaxAngleAt).u32());
  tool.marker_count = static_cast<int>(at(bytes, kMarkerCountAt).u32());
  tool.needed_markers = static_cast<int>(at(bytes, kNeededMarkersAt).u32());
  tool.max_error_mm = at(bytes, kMaxErrorAt).f32();
  tool.manufacturer = text_at(bytes, kManufacturerAt, kManufacturerBytes);
  tool.part_number = text_at(bytes, kPartNumberAt, kPartNumberBytes);
  if (!read_markers(bytes, tool)) return fail(subject + "has a marker position that is no number");
  return tool;
}

Result<ToolDefinition> read_tool_definition(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return fail("tool definition " + file.string() + " cannot be opened; a readable .rom file is wanted");
  std::vector<char> letters(kRomFileBytes + 1);
  in.read(letters.data(), static_cast<std::streamsize>(letters.size()));
  letters.resize(static_cast<std::size_t>(in.gcount()));
  // One byte too many says "too long" without reading all of a large file.
  return parse_tool_definition(std::as_bytes(std::span<const char>{letters}), file.string());
}

std::vector<Eigen::Vector3d> markers_of(const ToolDefinition& tool) {
  std::vector<Eigen::Vector3d> markers;
  for (const auto& [x, y, z] : std::span(tool.markers_mm).first(static_cast<std::size_t>(tool.marker_count)))
    markers.emplace_back(x, y, z);
  return markers;
}

}  // namespace orcart::ndi
