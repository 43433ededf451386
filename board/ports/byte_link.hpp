// The tracker's seam: bytes to and from a position sensor over USB serial, tty, TCP, a recording or a
// simulator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "board/ports/port_fault.hpp"
#include "realtime/base/result.hpp"
#include "realtime/kernel/wake_source.hpp"

namespace orcart {

enum class FlowControl : std::uint8_t { none, hardware };

/// A serial line's settings; links without a line (TCP) accept and ignore them.
struct LineSettings {
  std::uint32_t baud = 9600;
  FlowControl flow = FlowControl::none;
};

/// One thread calls; no call but wait() blocks. Bytes once read are gone; bytes that do not fit stay.
class ByteLink : public WakeSource {
 public:
  /// Hands bytes over for sending; they are sent in order. All or nothing.
  virtual Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept = 0;
  /// Takes what has arrived, at most into.size() bytes; 0 where nothing has.
  virtual Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept = 0;
  /// The host's stamp of the newest byte that read() has handed out.
  virtual Instant last_arrival() const noexcept = 0;
  /// Drops what has arrived and was not read, so that a late reply cannot answer the next command.
  virtual void discard_input() noexcept = 0;
  /// Takes effect for the next byte in either direction.
  virtual Result<void, PortFault> set_line(const LineSettings& line) noexcept = 0;
  /// A serial break: resets an NDI device.
  virtual Result<void, PortFault> send_break() noexcept = 0;
  /// After `disconnected`: tries to open the same device again. May take long; never called while painting
  /// goes on.
  virtual Result<void, PortFault> reopen() noexcept = 0;
};

}  // namespace orcart
