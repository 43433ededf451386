// Takes a command line apart.
#include "board/sim/ndi/command_line.hpp"

#include <charconv>

#include "realtime/base/crc16.hpp"

namespace orcart {
namespace {

constexpr std::size_t kCrcDigits = 4;

bool belongs_to_name(char letter) {
  return (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z') ||
         (letter >= '0' && letter <= '9');
}

}  // namespace

std::optional<std::uint32_t> parse_hex_field(std::string_view digits) noexcept {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  const bool whole = error == std::errc{} && end == digits.data() + digits.size() && digits.size() <= 8;
  return whole ? std::optional{value} : std::nullopt;
}

CommandLine parse_command_line(std::string_view line) noexcept {
  std::size_t name_size = 0;
  while (name_size < line.size() && belongs_to_name(line[name_size])) ++name_size;
  CommandLine command{.name = line.substr(0, name_size)};
  if (command.name.empty()) return {.error = NdiError::invalid_command};
  if (name_size == line.size()) return command;
  std::string_view rest = line.substr(name_size + 1);
  if (line[name_size] == ':') {
    if (rest.size() < kCrcDigits) return {.name = command.name, .error = NdiError::too_short};
    const auto stated = parse_hex_field(rest.substr(rest.size() - kCrcDigits));
    rest.remove_suffix(kCrcDigits);
    const bool good = stated && *stated == crc16(line.substr(0, line.size() - kCrcDigits));
    if (!good) return {.name = command.name, .error = NdiError::bad_crc};
  } else if (line[name_size] != ' ') {
    return {.name = command.name, .error = NdiError::invalid_command};
  }
  command.arguments = rest;
  return command;
}

}  // namespace orcart
