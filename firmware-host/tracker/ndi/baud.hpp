// The line rates an NDI device can be told to use, their codes in COMM, and how long bytes are on the wire.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "realtime/base/instant.hpp"

namespace orcart::ndi {

struct BaudCode {
  std::uint32_t baud;
  char code;  ///< the first letter of COMM's argument
};

/// From slow to fast.
inline constexpr std::array<BaudCode, 9> kBaudCodes{{{9600, '0'},
                                                     {14400, '1'},
                                                     {19200, '2'},
                                                     {38400, '3'},
                                                     {57600, '4'},
                                                     {115200, '5'},
                                                     {230400, 'A'},
                                                     {921600, '6'},
                                                     {1228739, '7'}}};
inline constexpr std::uint32_t kPowerOnBaud = 9600;

constexpr std::optional<char> code_of_baud(std::uint32_t baud) noexcept {
  for (const BaudCode& row : kBaudCodes) {
    if (row.baud == baud) return row.code;
  }
  return std::nullopt;
}

/// The fastest rate below `baud`, or nothing below the slowest. Passes over 14400 and 19200: few host drivers
/// have the first, and NDI's USB converters take the second for 1.2 Mbaud.
constexpr std::optional<std::uint32_t> next_slower(std::uint32_t baud) noexcept {
  for (std::size_t i = kBaudCodes.size(); i-- > 0;) {
    const bool avoided = kBaudCodes[i].baud == 14'400 || kBaudCodes[i].baud == 19'200;
    if (kBaudCodes[i].baud < baud && !avoided) return kBaudCodes[i].baud;
  }
  return std::nullopt;
}

/// Ten bits a byte (8N1). Baud 0 stands for a link without a line (TCP): no time at all.
constexpr Nanos wire_time(std::size_t bytes, std::uint32_t baud) noexcept {
  if (baud == 0) return Nanos{0};
  return Nanos{static_cast<std::int64_t>(bytes) * 10 * 1'000'000'000 / baud};
}

}  // namespace orcart::ndi
