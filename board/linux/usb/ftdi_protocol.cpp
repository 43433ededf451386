// Divisors, requests and packets.
#include "board/linux/usb/ftdi_protocol.hpp"

#include <algorithm>
#include <array>

namespace orcart::ftdi {
namespace {

constexpr std::uint32_t kFullSpeedHz = 3'000'000;
constexpr std::uint32_t kHighSpeedHz = 12'000'000;
constexpr std::uint32_t kSlowestHighSpeedBaud = 1200;
constexpr std::uint32_t kEighths = 8;
constexpr std::uint32_t kLongestDivisor = 0x3FFF;
/// How the chip encodes 0/8 to 7/8.
constexpr std::array<std::uint32_t, 8> kFractionCodes{0, 3, 2, 4, 1, 5, 6, 7};
constexpr std::uint32_t kHighSpeedFlag = 0x20000;

constexpr std::size_t kStatusBytes = 2;
constexpr std::uint8_t kOverrun = 0x02, kParity = 0x04, kFraming = 0x08, kBreak = 0x10;

bool uses_high_speed_clock(const Chip& chip, std::uint32_t baud) noexcept {
  return chip.base == ClockBase::mhz12 && baud >= kSlowestHighSpeedBaud;
}

std::uint32_t clock_hz(const Chip& chip, std::uint32_t baud) noexcept {
  return uses_high_speed_clock(chip, baud) ? kHighSpeedHz : kFullSpeedHz;
}

/// In eighths; 0 where the baud is out of reach. Between 1 and 2 the chip has 1 and 1.5 alone: those are 8
/// and 12.
std::uint32_t divisor_eighths(const Chip& chip, std::uint32_t baud) noexcept {
  if (baud == 0) return 0;
  const std::uint32_t hz = clock_hz(chip, baud);
  const std::uint32_t eighths = (hz * kEighths + baud / 2) / baud;
  if (eighths < kEighths || eighths / kEighths > kLongestDivisor) return 0;
  if (eighths > 2 * kEighths) return eighths;
  if (eighths <= 10) return kEighths;
  return eighths <= 14 ? 12 : 2 * kEighths;
}

std::uint32_t encoded(std::uint32_t eighths) noexcept {
  if (eighths == kEighths) return 0;  // 1 and 1.5 have codes of their own
  if (eighths == 12) return 1;
  return eighths / kEighths | kFractionCodes[eighths % kEighths] << 14;
}

std::uint16_t with_channel(std::uint32_t high_bits, const Chip& chip) noexcept {
  return static_cast<std::uint16_t>(chip.channel == 0 ? high_bits : high_bits << 8 | chip.channel);
}

}  // namespace

ClockBase clock_base_of(std::uint16_t bcd_device) noexcept {
  const unsigned family = bcd_device >> 8;
  return family >= 7 && family <= 9 ? ClockBase::mhz12 : ClockBase::mhz3;
}

std::optional<Request> set_baud(const Chip& chip, std::uint32_t baud) noexcept {
  const std::uint32_t eighths = divisor_eighths(chip, baud);
  if (eighths == 0) return std::nullopt;
  const std::uint32_t code = encoded(eighths) | (uses_high_speed_clock(chip, baud) ? kHighSpeedFlag : 0u);
  return Request{3, static_cast<std::uint16_t>(code & 0xFFFFu), with_channel(code >> 16, chip)};
}

double rate_of(const Chip& chip, std::uint32_t baud) noexcept {
  const std::uint32_t eighths = divisor_eighths(chip, baud);
  return eighths == 0 ? 0 : static_cast<double>(clock_hz(chip, baud)) * kEighths / eighths;
}

Request reset(const Chip& chip) noexcept {
  return {0, 0, chip.channel};
}
Request purge_receive(const Chip& chip) noexcept {
  return {0, 1, chip.channel};
}
Request purge_transmit(const Chip& chip) noexcept {
  return {0, 2, chip.channel};
}
Request raise_modem_lines(const Chip& chip) noexcept {
  return {1, 0x0303, chip.channel};
}
Request set_flow(const Chip& chip, FlowControl flow) noexcept {
  const std::uint16_t handshake = flow == FlowControl::hardware ? 0x0100 : 0;
  return {2, 0, static_cast<std::uint16_t>(handshake | chip.channel)};
}
Request set_data(const Chip& chip, Break line_break) noexcept {
  const std::uint16_t on = line_break == Break::on ? 0x4000 : 0;
  return {4, static_cast<std::uint16_t>(0x0008 | on), chip.channel};
}
Request set_latency_timer(const Chip& chip, std::uint8_t ms) noexcept {
  return {9, std::max<std::uint8_t>(1, ms), chip.channel};
}

std::size_t strip_status(std::span<const std::byte> transfer, std::size_t packet_bytes,
                         std::span<std::byte> into, LineErrors& errors) noexcept {
  std::size_t copied = 0;
  packet_bytes = std::max(packet_bytes, kStatusBytes + 1);
  while (transfer.size() >= kStatusBytes) {
    const auto line = std::to_integer<std::uint8_t>(transfer[1]);
    errors.overruns += (line & kOverrun) != 0 ? 1 : 0;
    errors.parity += (line & kParity) != 0 ? 1 : 0;
    errors.framing += (line & kFraming) != 0 ? 1 : 0;
    errors.breaks += (line & kBreak) != 0 ? 1 : 0;
    const auto packet = transfer.first(std::min(packet_bytes, transfer.size()));
    const auto payload = packet.subspan(kStatusBytes);
    const std::size_t count = std::min(payload.size(), into.size() - copied);
    std::copy_n(payload.begin(), count, into.begin() + static_cast<std::ptrdiff_t>(copied));
    copied += count;
    transfer = transfer.subspan(packet.size());
  }
  return copied;
}

}  // namespace orcart::ftdi
