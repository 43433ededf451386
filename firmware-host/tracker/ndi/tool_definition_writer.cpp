// Writes the fields of a tool definition where tool_definition.cpp reads them.
#include "firmware-host/tracker/ndi/tool_definition_writer.hpp"

#include <algorithm>
#include <bit>

namespace orcart::ndi {
namespace {

using File = std::array<std::byte, kRomFileBytes>;

void put_number(File& file, std::size_t at, std::uint32_t value, std::size_t size = 4) {
  for (std::size_t i = 0; i < size; ++i) file[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xFFu);
}

void put_float(File& file, std::size_t at, float value) {
  put_number(file, at, std::bit_cast<std::uint32_t>(value));
}

void put_text(File& file, std::size_t at, std::string_view text, std::size_t most) {
  for (std::size_t i = 0; i < std::min(text.size(), most); ++i)
    file[at + i] = static_cast<std::byte>(text[i]);
}

}  // namespace

File encode_tool_definition(const ToolDraft& draft) noexcept {
  const std::size_t count = std::min(draft.markers_mm.size(), ToolDefinition::kMaxMarkers);
  File file{};
  put_text(file, 0, "NDI", 3);
  put_number(file, 8, 1);
  put_number(file, 15, draft.main_type, 1);
  put_number(file, 20, draft.serial_number);
  put_number(file, 24, 90);
  put_number(file, 28, static_cast<std::uint32_t>(count));
  put_number(file, 32, 3);
  put_float(file, 36, draft.max_error_mm);
  put_float(file, 64, 10.0F);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      put_float(file, 72 + 12 * i + 4 * axis, draft.markers_mm[i][axis]);
  }
  put_text(file, 580, "orcart", 12);
  put_text(file, 592, draft.part_number, 20);
  std::uint32_t sum = 0;
  for (std::size_t i = 6; i < file.size(); ++i) sum += std::to_integer<std::uint32_t>(file[i]);
  put_number(file, 4, sum & 0xFFFFu, 2);
  return file;
}

}  // namespace orcart::ndi
