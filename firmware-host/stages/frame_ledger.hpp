// Every frame's and every capture's own instants, kept for the panel, the report and the tests. Fixed memory.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "firmware-host/stages/paint_order.hpp"

namespace orcart {

/// One frame that was shown.
struct FrameRecord {
  std::uint32_t sequence = 0;
  Instant mid_exposure{};
  Instant dequeued_at{};
  Instant uploaded_at{};   ///< taken over to the GPU
  Instant submitted_at{};  ///< the panel picture that holds it was handed over
  Instant scan_out_at{};   ///< start of the scan-out of that picture
  bool late = false;       ///< missed the first vblank after its submit deadline
};

/// One capture, from the pedal to the painting.
struct CaptureRecord {
  std::uint32_t unit = 0;
  std::uint32_t frame_sequence = 0;
  bool streaming = false;
  Refusal refusal = Refusal::none;
  Instant edge_at{};
  Instant acknowledged_at{};  ///< scan-out start of the first panel picture that says so
  Instant mid_exposure{};
  Instant matched_at{};
  Instant mapped_at{};
  Instant painted_at{};
  Instant on_panel_at{};  ///< scan-out start of the first panel picture that shows it
  Pose<M, C> X_MC;
  double turn_rad = 0;  ///< of the light post since the passport's turn
  PoseKind pose_kind = PoseKind::none;
  Nanos pose_distance{};
  std::optional<Twist> velocity;  ///< of C by the marker's movement, mm/s and rad/s in C; nothing: not known
  bool undone = false;
};

/// An append-only list of fixed capacity: one thread appends, any thread reads what is complete. Full:
/// counted.
template <class Record>
class Ledger {
 public:
  explicit Ledger(std::size_t capacity) : records_(capacity) {}
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  /// The writer's own: null where the ledger is full.
  Record* append(const Record& record) noexcept {
    const std::size_t n = size_.load(std::memory_order_relaxed);
    if (n == records_.size()) {
      overflow_.fetch_add(1, std::memory_order_relaxed);
      return nullptr;
    }
    records_[n] = record;
    size_.store(n + 1, std::memory_order_release);  // partner: size()
    return &records_[n];
  }
  std::size_t size() const noexcept { return size_.load(std::memory_order_acquire); }  // partner: append()
  std::uint64_t overflow() const noexcept { return overflow_.load(std::memory_order_relaxed); }
  Record& at(std::size_t i) noexcept { return records_[i]; }
  const Record& at(std::size_t i) const noexcept { return records_[i]; }

 private:
  std::vector<Record> records_;
  std::atomic<std::size_t> size_{0};
  std::atomic<std::uint64_t> overflow_{0};
};

}  // namespace orcart
