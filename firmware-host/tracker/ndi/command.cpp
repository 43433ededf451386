// How each NDI command is spelt.
#include "firmware-host/tracker/ndi/command.hpp"

#include <algorithm>
#include <charconv>

#include "firmware-host/tracker/ndi/hex.hpp"
#include "realtime/base/crc16.hpp"

namespace orcart::ndi {
namespace {

/// Arguments of the form hh, hhhh or hhhhhh, of which most commands are made.
template <std::size_t N>
struct HexArguments {
  std::array<char, N> letters{};
  explicit HexArguments(std::uint32_t value) { format_hex(value, letters); }
  std::string_view text() const { return {letters.data(), N}; }
};

}  // namespace

Command::Command(std::string_view name, std::string_view arguments, ReplyKind kind) noexcept
    : name_size_(name.size()), kind_(kind) {
  const std::size_t payload = name.size() + 1 + arguments.size();
  if (payload + 5 > kCapacity) {
    name_size_ = 0;
    return;
  }
  char* end = std::copy(name.begin(), name.end(), text_.data());
  *end++ = ':';
  end = std::copy(arguments.begin(), arguments.end(), end);
  format_hex(crc16(std::string_view{text_.data(), payload}), std::span<char>{end, 4});
  end[4] = '\r';
  size_ = payload + 5;
}

Command initialise() noexcept {
  return {"INIT", ""};
}

Command set_line(char code, bool hardware_flow) noexcept {
  const std::array<char, 5> arguments{code, '0', '0', '0', hardware_flow ? '1' : '0'};
  return {"COMM", {arguments.data(), arguments.size()}};
}

Command request_wireless_handle() noexcept {
  return {"PHRQ", "*********1****"};
}

Command write_rom(std::uint8_t handle, std::size_t block,
                  std::span<const std::byte, kRomBlockBytes> bytes) noexcept {
  std::array<char, 6 + 2 * kRomBlockBytes> arguments{};
  const std::span<char> letters{arguments};
  format_hex(handle, letters.first(2));
  format_hex(static_cast<std::uint32_t>(block * kRomBlockBytes), letters.subspan(2, 4));
  for (std::size_t i = 0; i < kRomBlockBytes; ++i) {
    format_hex(std::to_integer<std::uint32_t>(bytes[i]), letters.subspan(6 + 2 * i, 2));
  }
  return {"PVWR", {arguments.data(), arguments.size()}};
}

Command search_ports(PortSearch which) noexcept {
  return {"PHSR", HexArguments<2>(static_cast<std::uint32_t>(which)).text()};
}

Command initialise_port(std::uint8_t handle) noexcept {
  return {"PINIT", HexArguments<2>(handle).text()};
}

Command enable_port(std::uint8_t handle, TrackingPriority priority) noexcept {
  std::array<char, 3> arguments{'0', '0', static_cast<char>(priority)};
  format_hex(handle, std::span<char>{arguments}.first(2));
  return {"PENA", {arguments.data(), arguments.size()}};
}

Command free_port(std::uint8_t handle) noexcept {
  return {"PHF", HexArguments<2>(handle).text()};
}

Command describe_port(std::uint8_t handle, std::uint16_t options) noexcept {
  return {"PHINF", HexArguments<6>(static_cast<std::uint32_t>(handle) << 16 | options).text()};
}

Command start_tracking() noexcept {
  return {"TSTART", ""};
}

Command stop_tracking() noexcept {
  return {"TSTOP", ""};
}

Command poll_text(std::uint16_t options) noexcept {
  return {"TX", HexArguments<4>(options).text()};
}

Command poll_frames() noexcept {
  return {"BX2", "--6d=tools --3d=none --sensor=none --1d=none", ReplyKind::binary};
}

Command beep(int times) noexcept {
  const char digit = static_cast<char>('0' + std::clamp(times, 1, 9));
  return {"BEEP", {&digit, 1}};
}

Command ask_api_revision() noexcept {
  return {"APIREV", ""};
}

Command ask_version() noexcept {
  return {"VER", "0"};
}

Command get_parameter(std::string_view name) noexcept {
  return {"GET", name};
}

Command set_parameter(std::string_view name, std::uint32_t value) noexcept {
  std::array<char, 120> assignment{};
  if (name.size() + 12 > assignment.size()) return {};
  char* end = std::copy(name.begin(), name.end(), assignment.data());
  *end++ = '=';
  end = std::to_chars(end, assignment.data() + assignment.size(), value).ptr;
  return {"SET", {assignment.data(), static_cast<std::size_t>(end - assignment.data())}};
}

Command set_illuminator_rate(int code) noexcept {
  const char digit = static_cast<char>('0' + std::clamp(code, 0, 2));
  return {"IRATE", {&digit, 1}};
}

Command poll_binary(std::uint16_t options) noexcept {
  return {"BX", HexArguments<4>(options).text(), ReplyKind::binary};
}

}  // namespace orcart::ndi
