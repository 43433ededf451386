// Brings poses, frames and presses together by their stamps: which frame may be painted, from where, and
// which press meant it. Thread: mapping. Rate: topology. Budget: row "match".
#pragma once

#include "firmware-host/stages/lanes.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/sync/capture_selector.hpp"
#include "realtime/sync/frame_matcher.hpp"
#include "realtime/sync/pose_history.hpp"

namespace orcart {

struct SyncStageSettings {
  PoseHistorySettings history;
  FrameMatcherSettings matcher;
  CaptureSelectorSettings selector;
  Pose<M, R> X_MR;                ///< registration
  Pose<S, C> X_SC;                ///< hand-eye
  bool painting_blocked = false;  ///< every press fails, and says so
};

class SyncStage final : public Stage {
 public:
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
};

}  // namespace orcart
