// Hexadecimal numbers as NDI messages carry them: fixed width, upper case, no prefix.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace orcart::ndi {

/// The value of one digit of either case, or -1.
constexpr int hex_digit(char letter) noexcept {
  if (letter >= '0' && letter <= '9') return letter - '0';
  if (letter >= 'A' && letter <= 'F') return letter - 'A' + 10;
  if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
  return -1;
}

/// All of `digits` (1 to 8 of them) as one number; nothing where a letter is no digit.
constexpr std::optional<std::uint32_t> parse_hex(std::string_view digits) noexcept {
  if (digits.empty() || digits.size() > 8) return std::nullopt;
  std::uint32_t value = 0;
  for (const char letter : digits) {
    const int digit = hex_digit(letter);
    if (digit < 0) return std::nullopt;
    value = value << 4 | static_cast<std::uint32_t>(digit);
  }
  return value;
}

/// Fills all of `into` with the lowest digits of `value`.
constexpr void format_hex(std::uint32_t value, std::span<char> into) noexcept {
  for (std::size_t i = into.size(); i-- > 0; value >>= 4) into[i] = "0123456789ABCDEF"[value & 0xFu];
}

}  // namespace orcart::ndi
