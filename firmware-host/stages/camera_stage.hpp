// Takes filled buffers from the camera, says when they were exposed, and gives empty ones back. Thread:
// camera. Rate: when a frame comes. Budget: topology, row "camera".
#pragma once

#include "board/ports/frame_source.hpp"
#include "firmware-host/camera/frame_intake.hpp"
#include "firmware-host/stages/lanes.hpp"
#include "firmware-host/stages/watched_fault.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/optics/notch_search.hpp"

namespace orcart {

class CameraStage final : public Stage {
 public:
  /// `notch`: looks for it in every picture; null: nobody asks.
  CameraStage(FrameSource& source, const Clock& clock, const StampSettings& stamps, Lanes& lanes,
              NotchSearch* notch = nullptr)
      : source_(source), clock_(clock), intake_(stamps), lanes_(lanes), notch_(notch) {}

  std::string_view name() const noexcept override { return "camera"; }
  StepReport step(Instant now) noexcept override;

  const CameraNews& news() const noexcept { return news_; }  ///< the stage's own thread, or after it ended
  const CameraHealth& health() const noexcept { return intake_.health(); }  ///< likewise

  /// What take() last failed with; nothing_yet since a frame came. A damaged frame counts once they have all
  /// been damaged for kDamagedFor. Any thread.
  PortFault fault() const noexcept { return fault_.get(); }

  /// After a fault the stream is started again at once, then after 0.1 s, each time twice as late, up to 1 s.
  static constexpr Nanos kFirstRetry = 100ms, kLastRetry = 1s;
  static constexpr Nanos kDamagedFor = 1s;

 private:
  void recover(PortFault fault) noexcept;
  void note_damaged() noexcept;

  FrameSource& source_;
  const Clock& clock_;
  FrameIntake intake_;
  Lanes& lanes_;
  NotchSearch* notch_;
  CameraNews news_;
  WatchedFault fault_;
  Instant retry_at_{};
  Instant damaged_since_ = Instant::max();  ///< the first damaged frame since a good one
  Nanos retry_after_ = kFirstRetry;
};

}  // namespace orcart
