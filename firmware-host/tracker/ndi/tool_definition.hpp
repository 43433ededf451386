// A wireless tool's definition (.rom file): checked on reading, kept as the bytes that are uploaded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "firmware-host/tracker/ndi/command.hpp"
#include "realtime/base/result.hpp"

namespace orcart::ndi {

struct ToolDefinition {
  static constexpr std::size_t kMaxMarkers = 20;

  std::array<std::byte, kRomMemoryBytes> memory{};             ///< the file, padded with zeros
  std::array<std::array<float, 3>, kMaxMarkers> markers_mm{};  ///< in the tool's own frame
  int marker_count = 0;
  int needed_markers = 0;
  float max_error_mm = 0;
  int max_angle_deg = 0;
  std::uint8_t main_type = 0;  ///< 1 reference, 2 probe, ...
  std::uint32_t serial_number = 0;
  std::string manufacturer;
  std::string part_number;

  TrackingPriority priority() const noexcept {
    return main_type == 1 ? TrackingPriority::still : TrackingPriority::moving;
  }
};

/// A file's size; 752 bytes, as NDI's editor writes them.
inline constexpr std::size_t kRomFileBytes = 752;

/// `name` is what an error calls it. Refused: a wrong size, another kind of file, a bad checksum, fewer than
/// 3 or more than 20 markers, marker positions that are no numbers.
Result<ToolDefinition> parse_tool_definition(std::span<const std::byte> bytes, std::string_view name);
Result<ToolDefinition> read_tool_definition(const std::filesystem::path& file);

/// Its markers in the tool's own frame, mm; none of a wired tool, whose definition stays in its own memory.
std::vector<Eigen::Vector3d> markers_of(const ToolDefinition& tool);

}  // namespace orcart::ndi
