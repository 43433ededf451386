// Messages as they stand in recordings of real devices, and helpers to damage them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "realtime/base/crc16.hpp"

namespace orcart::testing {

inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span<const char>{text.data(), text.size()});
}

/// A text with its CRC and carriage return.
inline std::string framed(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  const unsigned crc = crc16(text);
  std::string message(text);
  for (int shift = 12; shift >= 0; shift -= 4) message += kDigits[crc >> shift & 0xFu];
  return message + '\r';
}

/// A body with header and CRC.
inline std::string framed_binary(std::string_view body) {
  const auto put = [](std::string& to, unsigned value) {
    to += static_cast<char>(value & 0xFFu);
    to += static_cast<char>(value >> 8 & 0xFFu);
  };
  std::string message = "\xC4\xA5";
  put(message, static_cast<unsigned>(body.size()));
  put(message, crc16(message));
  message += body;
  put(message, crc16(body));
  return message;
}

/// A Polaris, 31 August 2005: two tools missing.
inline const std::string kTwoMissing{
    "\xC4\xA5\x17\x00\"\xE3\x02\x01\x02"
    "1\x00\x00\x00\"\x01\x00\x00\x02\x02"
    "1\x00\x00\x00!\x01\x00\x00\x00\x00\xD3\xFF",
    31};

/// The same device: the second tool seen.
inline const std::string kOneSeen{
    "\xC4\xA5\x37\x00;#\x02\x01\x02"
    "1\x00\x00\x00(\x01\x00\x00\x02\x01\x7F(\x0F?\x80\x12\x1D? "
    "\x1D\xC6>\xA2\x80\xCD>\x1Cx\xB1\xC2\xD8\xD4$C\xC8\x7F\x09"
    "\xC5\xC5_\x0A=1\x00\x00\x00*\x01\x00\x00\x00\x00\x07\xA1",
    63};

}  // namespace orcart::testing
