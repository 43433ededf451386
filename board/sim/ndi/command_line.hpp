// One line from the host, taken apart: both forms of NDI commands, with `:` and a CRC, or with a blank and
// none.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "board/sim/ndi/emulated_port.hpp"

namespace orcart {

struct CommandLine {
  std::string_view name;
  std::string_view arguments;
  NdiError error = NdiError::none;
};

/// `line` comes without its carriage return.
CommandLine parse_command_line(std::string_view line) noexcept;

/// All of `digits` (1 to 8 of them) as one number.
std::optional<std::uint32_t> parse_hex_field(std::string_view digits) noexcept;

}  // namespace orcart
