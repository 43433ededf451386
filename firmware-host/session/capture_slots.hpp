// The hand-over from the render thread to the session thread: pictures are copied into slots taken before
// arming.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/session/session_records.hpp"
#include "realtime/kernel/pool.hpp"
#include "realtime/kernel/spsc_queue.hpp"

namespace orcart {

struct CaptureSlot {
  std::vector<std::byte> pixels;  ///< as large as any picture of this run
  std::size_t used_bytes = 0;
  CapturedFrame frame;  ///< its image describes `pixels`; the camera's buffer has gone home
  CaptureFacts facts;

  std::span<const std::byte> picture() const { return std::span(pixels).first(used_bytes); }
};

/// What the session thread is told, in order.
struct SessionNote {
  enum class Kind : std::uint8_t { captured, undone };
  Kind kind = Kind::captured;
  PoolHandle slot;         ///< captured: to be given back
  std::uint32_t unit = 0;  ///< undone
};

/// offer() and undone() from one real-time thread, next() and give_back() from one other. No call waits.
class CaptureSlots {
 public:
  /// `picture_bytes`: of the largest picture, packed tightly.
  CaptureSlots(std::size_t count, std::size_t picture_bytes);

  /// Copies the picture. False: it will not be kept, since the session thread is behind or the pixels are not
  /// in this process's memory; counted.
  bool offer(const CapturedFrame& frame, const CaptureFacts& facts) noexcept;
  /// The unit was taken back. False: that will not be kept; counted.
  bool undone(std::uint32_t unit) noexcept;

  std::optional<SessionNote> next() noexcept;
  const CaptureSlot& operator[](PoolHandle handle) const noexcept { return slots_[handle]; }
  void give_back(PoolHandle handle) noexcept { slots_.give_back(handle); }

  /// Any thread: what was not kept.
  std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }  // a count alone

 private:
  bool count_lost() noexcept;

  static constexpr std::size_t kUndosAhead = 64;
  Pool<CaptureSlot> slots_;
  SpscQueue<SessionNote> notes_;
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace orcart
