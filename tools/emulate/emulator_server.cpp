// Bytes between the port and the emulated tracker.
#include "tools/emulate/emulator_server.hpp"

#include <algorithm>

namespace orcart {

void EmulatorServer::step(Nanos longest) {
  if (device_.faults().active(NdiFault::cut, clock_.now(), 0) != nullptr) {
    port_.cut();
  } else {
    port_.mend();
  }
  const Nanos until_reply =
      device_.next_event() == Instant::max() ? longest : device_.next_event() - clock_.now();
  port_.wait(std::clamp(until_reply, Nanos{0}, longest));
  const Instant now = clock_.now();
  watch_for_break(now);
  if (port_.take_arrival()) device_.change_host(now);
  while (const std::size_t count = port_.read(buffer_)) {
    device_.receive(std::span{buffer_}.first(count), now);
    bytes_received_ += count;
    baud_ = port_.baud();
    break_at_ = Instant::max();
  }
  while (const std::size_t count = device_.read(buffer_, now)) {
    port_.write(std::span{buffer_}.first(count));
    bytes_sent_ += count;
  }
  if (!device_.owes_a_reply()) port_.owe_nothing();
}

void EmulatorServer::watch_for_break(Instant now) {
  const std::uint32_t baud = port_.baud();
  if (baud != baud_) break_at_ = baud == 9600 ? now + kSilenceIsBreak : Instant::max();
  baud_ = baud;
  if (now < break_at_) return;
  break_at_ = Instant::max();
  device_.receive_break(now);
}

}  // namespace orcart
