// Refuses frames whose stamps cannot be true, and calls it a fault when that goes on.
#pragma once

#include <cstdint>

#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/refusal.hpp"

namespace orcart {

/// One thread.
class StampCheck {
 public:
  static constexpr Nanos kTolerance = 1ms;
  static constexpr std::uint32_t kFaultAfter = 3;

  /// stamp_in_future where the exposure ended after the frame was dequeued, stamp_backwards where it began
  /// before its predecessor's, each by more than 1 ms; else none. After a fault the stamps count anew from
  /// this frame: a driver that set its clock back is refused 3 times, not for ever.
  Refusal check(const CapturedFrame& frame) noexcept {
    const bool backwards = have_last_ && frame.exposure_start < last_start_ - kTolerance;
    const bool future = frame.exposure_end > frame.dequeued_at + kTolerance;
    const Refusal refusal = future      ? Refusal::stamp_in_future
                            : backwards ? Refusal::stamp_backwards
                                        : Refusal::none;
    refused_in_a_row_ = refusal == Refusal::none ? 0 : refused_in_a_row_ + 1;
    if (refusal == Refusal::none || (backwards && !future && faulty())) {
      last_start_ = frame.exposure_start;
      have_last_ = true;
    }
    if (refusal != Refusal::none) ++refused_;
    return refusal;
  }

  /// 3 frames in a row were refused.
  bool faulty() const noexcept { return refused_in_a_row_ >= kFaultAfter; }
  std::uint32_t refused() const noexcept { return refused_; }

 private:
  Instant last_start_{};
  bool have_last_ = false;
  std::uint32_t refused_in_a_row_ = 0;
  std::uint32_t refused_ = 0;
};

}  // namespace orcart
