// Carries bytes between a driver and the emulated tracker.
#include "board/sim/ndi/simulated_byte_link.hpp"

#include <algorithm>

namespace orcart {

Result<void, PortFault> SimulatedByteLink::write(std::span<const std::byte> bytes) noexcept {
  if (!usable()) return tl::unexpected(PortFault::disconnected);
  if (line_.baud == device_.baud(clock_.now())) {
    device_.receive(bytes, clock_.now());
  } else {
    device_.receive_noise();
  }
  return {};
}

Result<std::size_t, PortFault> SimulatedByteLink::read(std::span<std::byte> into) noexcept {
  if (!usable()) return tl::unexpected(PortFault::disconnected);
  const std::size_t count = device_.read(into, clock_.now());
  if (line_.baud != device_.baud(clock_.now())) {
    for (std::byte& byte : into.first(count)) byte = (byte << 1) ^ std::byte{0x99};
  }
  return count;
}

Result<void, PortFault> SimulatedByteLink::set_line(const LineSettings& line) noexcept {
  if (!usable()) return tl::unexpected(PortFault::disconnected);
  line_ = line;
  return {};
}

Result<void, PortFault> SimulatedByteLink::send_break() noexcept {
  if (!usable()) return tl::unexpected(PortFault::disconnected);
  device_.receive_break(clock_.now());
  return {};
}

Result<void, PortFault> SimulatedByteLink::reopen() noexcept {
  if (!plugged_) return tl::unexpected(PortFault::disconnected);
  open_ = true;
  device_.discard(clock_.now());
  return {};
}

Instant SimulatedByteLink::next_event() const noexcept {
  if (!open_) return Instant::max();
  return plugged_ ? device_.next_event() : clock_.now();  // the fault is there to be read
}

void SimulatedByteLink::wait(Instant deadline) noexcept {
  clock_.sleep_until(std::max(clock_.now(), std::min(deadline, next_event())));
}

}  // namespace orcart
