// Hands bytes over as they arrive.
#include "board/sim/ndi/reply_queue.hpp"

#include <algorithm>

namespace orcart {

Instant ReplyQueue::Reply::arrival_of(std::size_t index) const noexcept {
  const std::size_t packet_end = std::min(size, (index / packet_bytes + 1) * packet_bytes);
  return begins_at + byte_time * static_cast<std::int64_t>(packet_end);
}

void ReplyQueue::pop() noexcept {
  first_ = (first_ + 1) % kDepth;
  --count_;
}

void ReplyQueue::push(std::span<const std::byte> bytes, Instant begins_at, Nanos byte_time,
                      std::size_t packet_bytes) noexcept {
  if (bytes.empty()) return;
  if (count_ == kDepth) pop();
  Reply& reply = replies_[(first_ + count_) % kDepth];
  reply.size = std::min(bytes.size(), reply.bytes.size());
  std::copy_n(bytes.begin(), reply.size, reply.bytes.begin());
  reply.taken = 0;
  reply.begins_at = begins_at;
  reply.byte_time = byte_time;
  reply.packet_bytes = std::max<std::size_t>(1, packet_bytes);
  busy_until_ = begins_at + byte_time * static_cast<std::int64_t>(reply.size);
  ++count_;
}

std::size_t ReplyQueue::take(std::span<std::byte> into, Instant now) noexcept {
  std::size_t taken = 0;
  while (taken < into.size() && count_ > 0) {
    Reply& reply = front();
    const Instant arrival = reply.arrival_of(reply.taken);
    if (arrival > now) break;
    into[taken++] = reply.bytes[reply.taken++];
    last_taken_ = arrival;
    if (reply.taken == reply.size) pop();
  }
  return taken;
}

void ReplyQueue::drop_arrived(Instant now) noexcept {
  const Instant stamp = last_taken_;
  std::array<std::byte, 256> sink;
  while (take(sink, now) != 0) {
  }
  last_taken_ = stamp;
}

Instant ReplyQueue::next_arrival() const noexcept {
  if (count_ == 0) return Instant::max();
  const Reply& reply = replies_[first_];
  return reply.arrival_of(reply.taken);
}

}  // namespace orcart
