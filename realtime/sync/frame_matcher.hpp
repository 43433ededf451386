// Holds frames until the tracker's samples around their mid-exposure are in hand. Painting alone waits here;
// the live picture never does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/notch_turn.hpp"
#include "realtime/sync/pose_history.hpp"
#include "realtime/sync/refusal.hpp"
#include "realtime/sync/stamp_check.hpp"

namespace orcart {

struct FrameMatcherSettings {
  Nanos longest_wait = 60ms;           ///< from mid-exposure; then the frame is refused
  TurnSource turn = TurnSource::told;  ///< notch: a frame without a turn is refused
  Nanos tracker_against_video{};       ///< calibrated; added to mid-exposure before the pose is looked up
};

/// A frame and the pose it was taken from, or why there is none.
struct MatchedFrame {
  CapturedFrame frame;
  PoseAnswer pose;      ///< may_paint() where refusal is none
  double turn_rad = 0;  ///< of the light post since the passport's turn; 0 where it is told
  Refusal refusal = Refusal::none;
};

/// Every frame that is added comes back exactly once. One thread; fixed memory.
class FrameMatcher {
 public:
  static constexpr std::size_t kMostHeld = 4;

  explicit FrameMatcher(const FrameMatcherSettings& settings = {}) : settings_(settings) {}

  /// Holds the frame. What comes back is refused: this very frame, for its stamps, or the oldest held one,
  /// where kMostHeld were held already.
  [[nodiscard]] std::optional<MatchedFrame> add(const CapturedFrame& frame) noexcept;

  /// The oldest held frame, once its pose is decided or its wait is over; in order. Not before mid-exposure +
  /// `edge_grace`: until then a pedal edge that means it may still be on its way
  /// (CaptureSelector::edge_grace()). Call until nothing comes.
  std::optional<MatchedFrame> next(Instant now, const PoseHistory& poses, Nanos edge_grace = 5ms) noexcept;

  std::size_t held() const noexcept { return size_; }
  /// Frames whose stamps cannot be true keep coming.
  bool stamps_faulty() const noexcept { return stamps_.faulty(); }

 private:
  CapturedFrame pop() noexcept;

  FrameMatcherSettings settings_;
  StampCheck stamps_;
  std::array<CapturedFrame, kMostHeld> held_{};
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace orcart
