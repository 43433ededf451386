// A line to an emulated tracker: the tracker's seam without any device.
#pragma once

#include "board/ports/byte_link.hpp"
#include "board/sim/ndi/ndi_emulator.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// Starts at 9600 baud. While host and device use different rates, neither understands the other. One thread.
class SimulatedByteLink final : public ByteLink {
 public:
  SimulatedByteLink(NdiEmulator& device, Clock& clock) noexcept : device_(device), clock_(clock) {}

  /// Pulls the plug, or puts it back; the device stays powered.
  void unplug() noexcept { plugged_ = false; }
  void plug_in() noexcept { plugged_ = true; }

  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept override;
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept override;
  Instant last_arrival() const noexcept override { return device_.last_arrival(); }
  void discard_input() noexcept override { device_.discard(clock_.now()); }
  Result<void, PortFault> set_line(const LineSettings& line) noexcept override;
  Result<void, PortFault> send_break() noexcept override;
  Result<void, PortFault> reopen() noexcept override;
  void wait(Instant deadline) noexcept override;
  Instant next_event() const noexcept override;

 private:
  /// A link that was unplugged stays shut until it is opened again.
  bool usable() noexcept { return open_ = open_ && plugged_; }

  NdiEmulator& device_;
  Clock& clock_;
  LineSettings line_;
  bool plugged_ = true;
  bool open_ = true;
};

}  // namespace orcart
