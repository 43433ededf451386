// The CRC-16 that NDI devices put behind every message: x^16 + x^15 + x^2 + 1, bits reflected, starting from
// 0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace orcart {

/// The register after each possible byte, by the reflected polynomial 0xA001.
inline constexpr std::array<std::uint16_t, 256> kCrc16Table = [] {
  std::array<std::uint16_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? crc >> 1 ^ 0xA001u : crc >> 1;
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}();

constexpr std::uint16_t crc16_next(std::uint16_t crc, std::uint8_t byte) noexcept {
  return static_cast<std::uint16_t>(crc >> 8 ^ kCrc16Table[(crc ^ byte) & 0xFFu]);
}

/// Goes on from `start`, so that a message in pieces needs no copy. Any thread; any length.
constexpr std::uint16_t crc16(std::span<const std::byte> bytes, std::uint16_t start = 0) noexcept {
  for (const std::byte byte : bytes) start = crc16_next(start, std::to_integer<std::uint8_t>(byte));
  return start;
}

constexpr std::uint16_t crc16(std::string_view text, std::uint16_t start = 0) noexcept {
  for (const char letter : text) start = crc16_next(start, static_cast<std::uint8_t>(letter));
  return start;
}

}  // namespace orcart
