// A link with somebody in between: bytes changed on their way, a slow reopen(), breaks counted.
#pragma once

#include <algorithm>
#include <functional>
#include <string>

#include "board/ports/byte_link.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// Each write is a command; what one read takes is handed to `on_read` as it is.
class LinkBetween final : public ByteLink {
 public:
  LinkBetween(ByteLink& link, SimulatedClock& clock) noexcept : link_(link), clock_(clock) {}

  std::function<void(std::string&)> on_write, on_read;
  Nanos reopen_takes{};
  int breaks = 0, reopens = 0;
  Nanos shortest_pause = 1h;  ///< from the end of one reopen() to the beginning of the next

  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept override {
    if (!on_write) return link_.write(bytes);
    std::string text = text_of(bytes);
    on_write(text);
    return link_.write(std::as_bytes(std::span(text)));
  }
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept override {
    const auto got = link_.read(into);
    if (!got || *got == 0 || !on_read) return got;
    std::string text = text_of(into.first(*got));
    on_read(text);
    const auto bytes = std::as_bytes(std::span(text));
    std::copy(bytes.begin(), bytes.end(), into.begin());
    return bytes.size();
  }
  Instant last_arrival() const noexcept override { return link_.last_arrival(); }
  void discard_input() noexcept override { link_.discard_input(); }
  Result<void, PortFault> set_line(const LineSettings& line) noexcept override {
    return link_.set_line(line);
  }
  Result<void, PortFault> send_break() noexcept override {
    ++breaks;
    return link_.send_break();
  }
  Result<void, PortFault> reopen() noexcept override {
    if (reopens++ > 0) shortest_pause = std::min(shortest_pause, clock_.now() - reopened_at_);
    clock_.advance_to(clock_.now() + reopen_takes);
    reopened_at_ = clock_.now();
    return link_.reopen();
  }
  void wait(Instant deadline) noexcept override { link_.wait(deadline); }
  Instant next_event() const noexcept override { return link_.next_event(); }

 private:
  static std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  ByteLink& link_;
  SimulatedClock& clock_;
  Instant reopened_at_{};
};

}  // namespace orcart::testing
