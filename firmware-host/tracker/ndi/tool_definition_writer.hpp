// Makes a tool definition from marker positions: for simulated tools, which nobody has drawn in NDI's editor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "firmware-host/tracker/ndi/tool_definition.hpp"

namespace orcart::ndi {

struct ToolDraft {
  std::span<const std::array<float, 3>> markers_mm;  ///< 3 to 20, in the tool's own frame
  std::string_view part_number = "SIMULATED";        ///< at most 20 letters
  std::uint8_t main_type = 2;                        ///< 1 reference, 2 probe
  std::uint32_t serial_number = 1;                   ///< not 0: some clients wait for another
  float max_error_mm = 0.75F;
};

/// The bytes of the .rom file, checksum included.
std::array<std::byte, kRomFileBytes> encode_tool_definition(const ToolDraft& draft) noexcept;

}  // namespace orcart::ndi
