// Brings poses, frames and presses together by their stamps: which frame may be painted, from where, and
// which press meant it. Thread: mapping. Rate: topology. Budget: row "match".
#pragma once

#include "firmware-host/stages/lanes.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "realtime/sync/capture_selector.hpp"
#include "realtime/sync/frame_matcher.hpp"
#include "realtime/sync/pose_history.hpp"

namespace orcart {

struct SyncStageSettings {
  PoseHistorySettings history;
  FrameMatcherSettings matcher;
  CaptureSelectorSettings selector;
  Pose<M, R> X_MR;                ///< registration
  ScopeModel scope;               ///< the passport, with hand-eye and [turning]
  EncoderTurnSettings encoder{};  ///< where the turn is followed by one
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
        encoder_turn_(settings.encoder) {}

  std::string_view name() const noexcept override { return "match"; }
  StepReport step(Instant now) noexcept override;

 private:
  void hear_encoder() noexcept;
  std::uint32_t take_poses(Instant now) noexcept;
  std::optional<double> turn_at(const PoseSample& sample) const noexcept;
  std::optional<double> turn_by_markers(const PoseSample& sample) const noexcept;
  std::uint32_t take_presses() noexcept;
  std::uint32_t take_frames(Instant now) noexcept;
  void decide(Instant now) noexcept;
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
  std::optional<PoseSample> unheard_;  ///< a pose that waits for the encoder
};

}  // namespace orcart
