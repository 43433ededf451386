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
  bool painting_blocked = false;  ///< every press fails, and says so
};

class SyncStage final : public Stage {
 public:
  /// A second marker further than this off the calibrated axis was bent or has slipped: its turn is not
  /// believed.
  static constexpr double kMostSwing_rad = 5 * 3.14159265358979 / 180;

  SyncStage(const SyncStageSettings& settings, Lanes& lanes)
      : settings_(settings),
        lanes_(lanes),
        history_(settings.history),
        matcher_(settings.matcher),
        selector_(settings.selector) {}

  std::string_view name() const noexcept override { return "match"; }
  StepReport step(Instant now) noexcept override;

 private:
  std::uint32_t take_poses() noexcept;
  std::optional<double> turn_by_markers(const PoseSample& sample) const noexcept;
  std::uint32_t take_presses() noexcept;
  std::uint32_t take_frames(Instant now) noexcept;
  void decide(Instant now) noexcept;
  void select(const MatchedFrame& matched, Instant now) noexcept;
  void order(PaintOrderKind kind, const CaptureRequest& request) noexcept;
  void fail(const CaptureRequest& request, Refusal why) noexcept;
  void tell_scope(Instant now) noexcept;

  SyncStageSettings settings_;
  Lanes& lanes_;
  PoseHistory history_;
  FrameMatcher matcher_;
  CaptureSelector selector_;
  NotchTurn notch_turn_;
};

}  // namespace orcart
