// One command on its way and the reply to it: at most one is outstanding, and it has a deadline.
#pragma once

#include <array>
#include <cstdint>

#include "board/ports/byte_link.hpp"
#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/framing.hpp"

namespace orcart {

enum class ExchangeEvent : std::uint8_t {
  none,       ///< nothing outstanding, or still waiting
  reply,      ///< frame() is the reply; it may be text (ERRORhh) where binary was asked for
  damaged,    ///< a reply came with a bad CRC, or noise until the deadline
  timed_out,  ///< the deadline passed with no reply, or with half of one
  link_down,  ///< the link reports a fault; only a re-open helps
};

/// One thread; allocates nothing.
class Exchange {
 public:
  explicit Exchange(ByteLink& link) noexcept : link_(link) {}

  /// Drops what was left on the line and sends. False where the link is down.
  bool begin(const ndi::Command& command, Instant now, Nanos patience) noexcept;
  /// Waits for a text that comes by itself (RESET after a break).
  void await_text(Instant now, Nanos patience) noexcept;
  ExchangeEvent step(Instant now) noexcept;
  void abandon() noexcept { busy_ = false; }

  bool busy() const noexcept { return busy_; }
  Instant deadline() const noexcept { return deadline_; }
  Instant asked_at() const noexcept { return asked_at_; }
  Instant arrived_at() const noexcept { return arrived_at_; }
  /// Valid until the next begin().
  const ndi::ReplyFrame& frame() const noexcept { return frame_; }
  /// Bytes that belonged to no reply and were passed over to find this one.
  std::size_t skipped() const noexcept { return frame_.skipped; }

 private:
  void listen(Instant now, Nanos patience) noexcept;
  /// False where the link is down.
  bool fill() noexcept;
  ExchangeEvent end(ExchangeEvent event) noexcept;

  ByteLink& link_;
  std::array<std::byte, ndi::kMaxBinaryReplyBytes + 512> buffer_{};
  std::size_t size_ = 0;
  ndi::ReplyFrame frame_;
  ndi::ReplyKind kind_ = ndi::ReplyKind::ascii;
  bool busy_ = false;
  Instant asked_at_{};
  Instant arrived_at_{};
  Instant deadline_{};
};

}  // namespace orcart
