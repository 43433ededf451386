// What an FTDI USB-serial bridge is told and what it sends, as arithmetic on bytes: no libusb, no state.
// Numbers as in the Linux driver ftdi_sio and in FTDI's application notes on baud divisors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "board/ports/byte_link.hpp"
#include "realtime/base/instant.hpp"

namespace orcart::ftdi {

/// A vendor request to the device (bmRequestType 0x40) without data.
struct Request {
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  bool operator==(const Request&) const = default;
};

/// Full-speed chips divide 3 MHz in eighths; high-speed ones (bcdDevice 0x0700 to 0x0900) 12 MHz.
enum class ClockBase : std::uint8_t { mhz3, mhz12 };
ClockBase clock_base_of(std::uint16_t bcd_device) noexcept;

/// The bridge of one channel. `channel` is 0 on chips with one channel, else 1 for the first.
struct Chip {
  ClockBase base = ClockBase::mhz3;
  std::uint8_t channel = 0;
};

/// The nearest divisor, encoded as the request to set it; nothing outside 183 baud (high speed: 1200) to 3
/// (12) Mbaud.
std::optional<Request> set_baud(const Chip& chip, std::uint32_t baud) noexcept;
/// The rate that the divisor nearest to `baud` really gives; 0 where there is none.
double rate_of(const Chip& chip, std::uint32_t baud) noexcept;

Request reset(const Chip& chip) noexcept;
Request purge_receive(const Chip& chip) noexcept;
Request purge_transmit(const Chip& chip) noexcept;
/// DTR and RTS on: the far side may send.
Request raise_modem_lines(const Chip& chip) noexcept;
Request set_flow(const Chip& chip, FlowControl flow) noexcept;
enum class Break : std::uint8_t { off, on };
/// 8 data bits, no parity, one stop bit.
Request set_data(const Chip& chip, Break line_break) noexcept;
/// How long the chip waits for more bytes before it sends a packet that is not full: 1 to 255 ms.
Request set_latency_timer(const Chip& chip, std::uint8_t ms) noexcept;

/// What two bytes in front of each packet say of the line.
struct LineErrors {
  std::uint32_t overruns = 0;
  std::uint32_t parity = 0;
  std::uint32_t framing = 0;
  std::uint32_t breaks = 0;
};

/// Every packet of `packet_bytes` in a transfer begins with two status bytes, also the last, shorter one.
/// Copies what is between them into `into` (never more than fits) and counts what the status says. Returns
/// the bytes copied.
std::size_t strip_status(std::span<const std::byte> transfer, std::size_t packet_bytes,
                         std::span<std::byte> into, LineErrors& errors) noexcept;

}  // namespace orcart::ftdi
