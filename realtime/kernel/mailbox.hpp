// The latest value from one thread to one other: posting overwrites, taking gets the newest, neither ever
// waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace orcart {

/// A triple buffer: the writer fills its back slot, the reader reads its front slot, and the third changes
/// hands in one exchange. One writer thread calls post, one reader thread calls take.
template <class T, template <class> class Atomic = std::atomic>
class LatestMailbox {
  // Not is_nothrow_copy_assignable: Eigen does not say of its fixed-size matrices that copying them cannot
  // throw.
  static_assert(std::is_copy_assignable_v<T>,
                "values are copied inside noexcept code: copying must not throw");

 public:
  /// Writer. Replaces what was not taken yet.
  void post(const T& value) noexcept {
    slots_[back_] = value;
    // Release partner: the exchange in take (publishes the slot). Acquire partner: the same exchange (the
    // slot we get back has been read to its end).
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Reader. True: `value` is newer than the last one taken. False: nothing new, `value` is left alone.
  bool take(T& value) noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0)
      return false;  // a hint; no slot is read on it
    // Acquire partner: the exchange in post (the slot is filled). Release partner: the same (our slot is
    // read).
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    value = slots_[front_];
    return true;
  }

 private:
  static constexpr std::uint32_t kFresh = 4;  ///< set in middle_ where its slot has not been taken
  static constexpr std::uint32_t kIndex = 3;

  std::array<T, 3> slots_{};
  alignas(64) std::uint32_t back_ = 0;  ///< the writer's own
  alignas(64) Atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t front_ = 2;  ///< the reader's own
};

}  // namespace orcart
