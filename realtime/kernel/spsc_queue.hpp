// A bounded queue from one thread to one other: never blocks, never allocates, counts what did not fit.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace orcart {

/// One producer thread calls try_push, one consumer thread calls try_pop; the rest is for any thread.
/// `Atomic` is std::atomic in the product and a model checker's twin in its tests.
template <class T, template <class> class Atomic = std::atomic>
class SpscQueue {
  // Not is_nothrow_copy_assignable: Eigen does not say of its fixed-size matrices that copying them cannot
  // throw.
  static_assert(std::is_copy_assignable_v<T>,
                "elements are copied inside noexcept code: copying must not throw");

 public:
  /// Takes the memory for `capacity` elements, once. A queue of capacity 0 refuses every push.
  explicit SpscQueue(std::size_t capacity)
      : capacity_(capacity),
        mask_(std::bit_ceil(capacity) - 1),
        slots_(std::make_unique<Slot[]>(mask_ + 1)) {}

  /// Producer. Full: counts a drop, changes nothing else and returns false.
  bool try_push(const T& element) noexcept {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);  // own index
    if (tail - head_seen_ >= capacity_) {
      head_seen_ =
          head_.load(std::memory_order_acquire);  // partner: the release in try_pop, which freed the slot
      if (tail - head_seen_ >= capacity_) return count_drop();
    }
    Slot& slot = slots_[tail & mask_];
    slot.element = element;
    tail_.store(tail + 1, std::memory_order_relaxed);       // for size(); no slot is read by it
    slot.count.store(tail + 1, std::memory_order_release);  // partner: the acquire of count in try_pop
    return true;
  }

  /// Consumer. Empty: leaves `element` alone and returns false.
  bool try_pop(T& element) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);  // own index
    const Slot& slot = slots_[head & mask_];
    // Partner: the release in try_push, which filled the slot. Before that the count is at most head.
    if (slot.count.load(std::memory_order_acquire) != head + 1) return false;
    element = slot.element;
    head_.store(head + 1, std::memory_order_release);  // partner: the acquire of head_ in try_push
    return true;
  }

  /// Elements waiting: exact where both threads stand still, else a value of a moment ago.
  std::size_t size() const noexcept {
    // Partner: the release in try_pop, which came after try_push's of the slot and so after its tail: a head
    // once seen implies every tail up to it, and the difference is never negative.
    const std::uint64_t head = head_.load(std::memory_order_acquire);
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);  // a count to look at; no slot is read
    return std::min(capacity_, static_cast<std::size_t>(tail - head));
  }

  std::size_t capacity() const noexcept { return capacity_; }

  /// Pushes refused since the start.
  std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }  // a count alone

 private:
  static constexpr std::size_t kCacheLine = 64;

  bool count_drop() noexcept {
    // One writer, the producer: load and store need not be one step. No partner, the count stands alone.
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return false;
  }

  /// An element and its number travel in one cache line, if the element is below 57 bytes.
  struct alignas(kCacheLine) Slot {
    Atomic<std::uint64_t> count{0};  ///< elements pushed when this one was; 0: none yet
    T element{};
  };

  const std::size_t capacity_;
  const std::uint64_t mask_;
  const std::unique_ptr<Slot[]> slots_;
  alignas(kCacheLine) Atomic<std::uint64_t> tail_{0};  ///< next to be filled; written by the producer
  std::uint64_t head_seen_ = 0;                        ///< producer's last look at head_
  Atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) Atomic<std::uint64_t> head_{0};  ///< next to be emptied; written by the consumer
};

}  // namespace orcart
