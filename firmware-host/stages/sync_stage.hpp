// Brings poses, frames and presses together by their stamps: which frame may be painted, from where, and
// which press meant it. Thread: mapping. Rate: topology. Budget: row "match".
#pragma once

#include <atomic>
#include <optional>

#include "firmware-host/stages/lanes.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "realtime/sync/capture_selector.hpp"
#include "realtime/sync/frame_matcher.hpp"
#include "realtime/sync/pose_history.hpp"
#include "realtime/sync/turn_check.hpp"

namespace orcart {

struct SyncStageSettings {
  PoseHistorySettings history;
  FrameMatcherSettings matcher;
  CaptureSelectorSettings selector;
  Pose<M, R> X_MR;                ///< registration
  ScopeModel scope;               ///< the passport, with hand-eye and [turning]
  EncoderTurnSettings encoder{};  ///< where the turn is followed by one
  /// The notch in the pictures may say so far another turn; nothing: it is not looked for, or is what is
  /// followed. An encoder without a zero gets it by the notch then.
  std::optional<double> most_mismatch_rad;
  bool painting_blocked = false;  ///< every press fails, and says so
};

class SyncStage final : public Stage {
 public:
  /// A second marker further than this off the calibrated axis was bent or has slipped: its turn is not
  /// believed.
  static constexpr double kMostSwing_rad = 5 * 3.14159265358979 / 180;
  /// A pose waits so long for the encoder to be heard up to its instant; then it has no turn.
  static constexpr Nanos kLongestHearing = 20ms;

  SyncStage(const SyncStageSettings& settings, Lanes& lanes)
      : settings_(settings),
        lanes_(lanes),
        history_(settings.history),
        matcher_(settings.matcher),
        selector_(settings.selector),
        encoder_turn_(settings.encoder) {
    if (settings.most_mismatch_rad) check_.emplace(*settings.most_mismatch_rad);
  }

  std::string_view name() const noexcept override { return "match"; }
  StepReport step(Instant now) noexcept override;

  /// By how many degrees the notch is further round than what is followed, where that is too far; 0: they
  /// agree. Any thread.
  int mismatch_deg() const noexcept { return mismatch_deg_.load(std::memory_order_relaxed); }  // alone

 private:
  /// The pictures by which an encoder gets its zero agree to this.
  static constexpr double kZeroWithin_rad = 3.14159265358979 / 180;

  void hear_encoder() noexcept;
  std::uint32_t take_poses(Instant now) noexcept;
  std::optional<double> turn_at(const PoseSample& sample) const noexcept;
  std::optional<double> turn_by_markers(const PoseSample& sample) const noexcept;
  std::uint32_t take_presses() noexcept;
  std::uint32_t take_frames(Instant now) noexcept;
  void decide(Instant now) noexcept;
  void compare_with_notch(const MatchedFrame& matched) noexcept;
  void find_zero(const CapturedFrame& frame) noexcept;
  void select(const MatchedFrame& matched, Instant now) noexcept;
  void order(PaintOrderKind kind, const CaptureRequest& request) noexcept;
  void fail(const CaptureRequest& request, Refusal why) noexcept;
  TurnLack lack_of_turn(Instant now, const PoseAnswer& pose) const noexcept;
  void tell_scope(Instant now) noexcept;

  SyncStageSettings settings_;
  Lanes& lanes_;
  PoseHistory history_;
  FrameMatcher matcher_;
  CaptureSelector selector_;
  NotchTurn notch_turn_;
  EncoderTurn encoder_turn_;
  std::optional<TurnCheck> check_;         ///< where the notch is compared
  TurnCheck zero_check_{kZeroWithin_rad};  ///< of the encoder's angle against the notch
  std::uint32_t zero_run_ = 0;             ///< of the encoder, that zero_check_ belongs to
  std::atomic<int> mismatch_deg_{0};
  std::optional<PoseSample> unheard_;  ///< a pose that waits for the encoder
};

}  // namespace orcart
