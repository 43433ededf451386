// A recorded dialogue as a link: the driver asks, the recording answers.
#pragma once

#include <array>
#include <vector>

#include "board/ports/byte_link.hpp"
#include "firmware-host/tracker/ndi/dialogue.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// A command is answered with the next recorded reply to the same command, else to a command of the same name
/// (for TX and BX only where it asked for transforms), else with OKAY, or as unknown where it is a question
/// about the device, or a way of asking for poses that the recording never used. Set-up commands may be
/// answered again and again; tracking replies are handed out once each, in order, and then the device is
/// silent. One thread; allocates only on construction.
class ReplayByteLink final : public ByteLink {
 public:
  ReplayByteLink(const ndi::Dialogue& dialogue, Clock& clock, Nanos reply_delay = 5ms);

  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept override;
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept override;
  Instant last_arrival() const noexcept override { return arrives_at_; }
  void discard_input() noexcept override { reply_ = {}; }
  Result<void, PortFault> set_line(const LineSettings&) noexcept override { return {}; }
  Result<void, PortFault> send_break() noexcept override;
  Result<void, PortFault> reopen() noexcept override { return {}; }
  void wait(Instant deadline) noexcept override;
  Instant next_event() const noexcept override { return reply_.empty() ? Instant::max() : arrives_at_; }
  /// All tracking replies have been handed out.
  bool finished() const noexcept { return finished_; }

 private:
  struct Turn {
    std::string command;
    std::string reply;
  };
  void answer(std::string_view reply) noexcept;
  /// The first turn from there on that answers the command, the very same before one of its name; -1 where
  /// none does.
  int find(std::string_view command, std::size_t from) const noexcept;

  std::vector<Turn> turns_;
  Clock& clock_;
  Nanos delay_;
  std::size_t next_tracking_ = 0;
  std::size_t next_set_up_ = 0;
  std::string_view reply_;
  Instant arrives_at_{};
  bool finished_ = false;
};

}  // namespace orcart
