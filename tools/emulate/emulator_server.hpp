// Serves the emulated tracker to whoever opens its port, on the wall clock.
#pragma once

#include <array>

#include "board/sim/ndi/ndi_emulator.hpp"
#include "realtime/kernel/clock.hpp"
#include "tools/emulate/emulator_port.hpp"

namespace orcart {

/// A pseudo-terminal carries no break. A client that sends one also goes (back) to 9600 baud and then waits
/// for RESET in silence; so a line set to 9600 on which nothing is said for kSilenceIsBreak is taken for a
/// break. Clients that talk at once never see it, and those that come later drop it with the rest of their
/// input. One thread.
class EmulatorServer {
 public:
  static constexpr Nanos kSilenceIsBreak = 600ms;

  EmulatorServer(NdiEmulator& device, EmulatorPort& port) noexcept : device_(device), port_(port) {}

  /// Waits for input or for the next reply byte, at most for `longest`, and carries the bytes.
  void step(Nanos longest);
  std::uint64_t bytes_received() const noexcept { return bytes_received_; }
  std::uint64_t bytes_sent() const noexcept { return bytes_sent_; }

 private:
  void watch_for_break(Instant now);

  NdiEmulator& device_;
  EmulatorPort& port_;
  RealClock clock_;
  std::array<std::byte, 4096> buffer_{};
  std::uint32_t baud_ = 0;
  Instant break_at_ = Instant::max();
  std::uint64_t bytes_received_ = 0;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace orcart
