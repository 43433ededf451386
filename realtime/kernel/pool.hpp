// Slots taken before arming and passed between threads by handle; empty ones come home by a return lane.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "realtime/kernel/spsc_queue.hpp"

namespace orcart {

/// Names one slot of one pool. Whoever holds it may use the slot, and must pass it on or give it back once.
struct PoolHandle {
  std::uint32_t index = 0;
  friend bool operator==(PoolHandle, PoolHandle) = default;
};

/// The owner thread takes slots and hands them on (by an SpscQueue<PoolHandle>, say); the consumer thread
/// gives them back. Memory is taken in the constructor only.
template <class Slot, template <class> class Atomic = std::atomic>
class Pool {
 public:
  using Handle = PoolHandle;

  explicit Pool(std::size_t count)
      : slots_(std::make_unique<Slot[]>(count)), count_(count), way_home_(count), away_(count, false) {
    free_.reserve(count);
    for (std::size_t i = count; i > 0; --i) free_.push_back({static_cast<std::uint32_t>(i - 1)});
  }

  /// Before arming: all slots, to be set up (buffers allocated, memory mapped).
  std::span<Slot> slots() noexcept { return {slots_.get(), count_}; }

  /// Whoever holds the handle.
  Slot& operator[](Handle handle) noexcept { return slots_[handle.index]; }
  const Slot& operator[](Handle handle) const noexcept { return slots_[handle.index]; }

  /// Owner thread: a free slot, after fetching what came home. None free: counted, and nothing returned.
  std::optional<Handle> take() noexcept {
    reclaim();
    if (free_.empty()) {
      // One writer, the owner; a count alone, no partner.
      exhausted_.store(exhausted_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return std::nullopt;
    }
    const Handle handle = free_.back();
    free_.pop_back();
    away_[handle.index] = true;
    return handle;
  }

  /// Consumer thread: the slot goes home. The lane holds every slot, so it is full only where one was given
  /// twice.
  void give_back(Handle handle) noexcept { way_home_.try_push(handle); }

  /// Owner thread: takes back a slot that was never handed on.
  void put_back(Handle handle) noexcept { welcome(handle); }

  /// Owner thread: fetches what came home; returns the number of free slots. take() does it by itself.
  std::size_t reclaim() noexcept {
    Handle handle;
    for (std::size_t i = 0; i < count_ && way_home_.try_pop(handle); ++i) welcome(handle);
    return free_.size();
  }

  std::size_t count() const noexcept { return count_; }
  /// Any thread: takes that found no free slot.
  std::uint64_t exhausted() const noexcept {
    return exhausted_.load(std::memory_order_relaxed);
  }  // a count alone
  /// Any thread: handles that came home though they were not away (the holder's bug); they were refused.
  std::uint64_t refused() const noexcept {
    return refused_.load(std::memory_order_relaxed) + way_home_.dropped();  // a count alone, no partner
  }

 private:
  void welcome(Handle handle) noexcept {
    if (handle.index >= count_ || !away_[handle.index]) {
      // One writer, the owner; a count alone, no partner.
      refused_.store(refused_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return;
    }
    away_[handle.index] = false;
    free_.push_back(handle);  // room was reserved for every slot
  }

  std::unique_ptr<Slot[]> slots_;
  std::size_t count_;
  SpscQueue<Handle, Atomic> way_home_;
  std::vector<bool> away_;  ///< the owner's: which slots are with somebody
  std::vector<Handle>
      free_;  ///< the owner's: the last one home is the first one out, still warm in the cache
  Atomic<std::uint64_t> exhausted_{0};
  Atomic<std::uint64_t> refused_{0};
};

}  // namespace orcart
