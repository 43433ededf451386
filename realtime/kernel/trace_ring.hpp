// The last few thousand things one thread did, kept in a fixed ring that another thread may copy at any time.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "realtime/base/instant.hpp"

namespace orcart {

/// What the runners themselves trace; stages of a program use kinds from `custom` on.
enum class TraceKind : std::uint16_t { none = 0, wake, step, slip, custom = 256 };

struct TraceEvent {
  Instant at;
  Nanos length{0};
  std::uint16_t stage = 0;  ///< index within its thread's plan
  TraceKind kind = TraceKind::none;
  std::uint32_t frame = 0;
  std::int64_t value = 0;  ///< the kind's own: items of a step, lateness of a wake in ns, periods of a slip
  friend bool operator==(const TraceEvent&, const TraceEvent&) = default;
};

/// One writer thread writes, overwriting the oldest; one ring a thread. Any thread may read: it gets only
/// events that were whole while it copied them. Takes its memory in the constructor.
template <template <class> class Atomic = std::atomic>
class BasicTraceRing {
 public:
  /// Room for at least `capacity` whole events, and the one being written.
  explicit BasicTraceRing(std::size_t capacity)
      : mask_(std::bit_ceil(capacity + 1) - 1), slots_(std::make_unique<Slot[]>(mask_ + 1)) {}

  /// Writer. A few stores; no call, no wait.
  void write(const TraceEvent& event) noexcept {
    const std::uint64_t number = written_.load(std::memory_order_relaxed);  // own count
    const Words words = std::bit_cast<Words>(event);
    Slot& slot = slots_[number & mask_];
    for (std::size_t i = 0; i < words.size(); ++i) {
      // Partner: the acquire of the same word in read(). Whoever sees this word also sees written_ == number
      // or more, and so knows that the older event in this slot is gone.
      slot.words[i].store(words[i], std::memory_order_release);
    }
    written_.store(number + 1,
                   std::memory_order_release);  // partner: the first acquire of written_ in read()
  }

  /// Any thread; allocates nothing. Copies the newest events, oldest of them first, and returns how many: at
  /// most out.size(), fewer where the writer overtook the copying.
  std::size_t read(std::span<TraceEvent> out) const noexcept {
    // Partner: the release of written_ in write(): every event below `end` is whole.
    const std::uint64_t end = written_.load(std::memory_order_acquire);
    const std::uint64_t kept = std::min<std::uint64_t>({end, mask_, out.size()});
    const std::uint64_t begin = end - kept;
    for (std::uint64_t i = 0; i < kept; ++i) out[i] = copy(slots_[(begin + i) & mask_]);
    // Ordered after the copies by their acquires; partner: see write(). The writer may be inside event
    // `now_end`, whose slot was that of event now_end - mask_ - 1.
    const std::uint64_t now_end = written_.load(std::memory_order_relaxed);
    const std::uint64_t first_whole = now_end > mask_ ? now_end - mask_ : 0;
    if (first_whole <= begin) return kept;
    const std::uint64_t spoilt = std::min(kept, first_whole - begin);
    std::copy(out.begin() + static_cast<std::ptrdiff_t>(spoilt),
              out.begin() + static_cast<std::ptrdiff_t>(kept), out.begin());
    return kept - spoilt;
  }

  /// The same into memory of its own, for reports. Off the real-time path.
  std::vector<TraceEvent> snapshot() const {
    std::vector<TraceEvent> events(capacity());
    events.resize(read(events));
    return events;
  }

  std::size_t capacity() const noexcept { return mask_; }
  /// Events written since the start; those beyond capacity() are gone.
  std::uint64_t written() const noexcept {
    return written_.load(std::memory_order_relaxed);
  }  // a count alone

 private:
  using Words = std::array<std::uint64_t, sizeof(TraceEvent) / sizeof(std::uint64_t)>;
  struct Slot {
    std::array<Atomic<std::uint64_t>, std::tuple_size_v<Words>> words{};
  };

  static TraceEvent copy(const Slot& slot) noexcept {
    Words words{};
    for (std::size_t i = 0; i < words.size(); ++i) {
      words[i] = slot.words[i].load(std::memory_order_acquire);  // partner: the release in write()
    }
    return std::bit_cast<TraceEvent>(words);
  }

  const std::uint64_t mask_;
  const std::unique_ptr<Slot[]> slots_;
  Atomic<std::uint64_t> written_{0};
};

using TraceRing = BasicTraceRing<>;

}  // namespace orcart
