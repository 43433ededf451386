// Replies on their way to the host: which byte has arrived by when.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "board/sim/ndi/wire_text.hpp"
#include "realtime/base/instant.hpp"

namespace orcart {

/// Bytes follow each other at the line's pace and reach the host in packets. One thread; allocates nothing.
class ReplyQueue {
 public:
  static constexpr std::size_t kDepth = 8;

  /// `begins_at` is when the first byte starts over the line, `byte_time` how long each takes, `packet_bytes`
  /// how many the host gets at a time (an FTDI bridge: 62). A full queue loses its oldest reply, as a
  /// device's buffer would.
  void push(std::span<const std::byte> bytes, Instant begins_at, Nanos byte_time,
            std::size_t packet_bytes) noexcept;
  /// Takes what has arrived by `now`, oldest first.
  std::size_t take(std::span<std::byte> into, Instant now) noexcept;
  void drop_arrived(Instant now) noexcept;
  void clear() noexcept { count_ = 0; }

  Instant next_arrival() const noexcept;
  /// When the newest byte that was taken arrived.
  Instant last_taken() const noexcept { return last_taken_; }
  /// When the line is free again.
  Instant busy_until() const noexcept { return busy_until_; }

 private:
  struct Reply {
    std::array<std::byte, WireText::kCapacity> bytes{};
    std::size_t size = 0;
    std::size_t taken = 0;
    Instant begins_at{};
    Nanos byte_time{};
    std::size_t packet_bytes = 1;

    Instant arrival_of(std::size_t index) const noexcept;
  };

  Reply& front() noexcept { return replies_[first_]; }
  void pop() noexcept;

  std::array<Reply, kDepth> replies_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  Instant last_taken_{};
  Instant busy_until_{};
};

}  // namespace orcart
