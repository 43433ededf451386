// Turns a driver's buffer into a frame with the instants that matter, and watches the camera's health.
// Thread: camera.
#pragma once

#include <cstdint>

#include "board/ports/frame_source.hpp"
#include "firmware-host/camera/picture_samples.hpp"
#include "firmware-host/camera/stamp_meaning.hpp"
#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/freeze_detector.hpp"
#include "realtime/sync/stamp_check.hpp"

namespace orcart {

/// What the camera has done since the start, and how its newest picture looks.
struct CameraHealth {
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;      ///< by gaps in the driver's sequence
  std::uint32_t restarts = 0;  ///< the sequence fell back: the stream was started anew
  std::uint32_t repeats = 0;   ///< pictures equal to their predecessor
  bool frozen = false;         ///< VIDEO FROZEN?
  bool stamps_faulty = false;  ///< 3 frames in a row with impossible stamps
  PictureSamples newest;
};

/// One thread; allocates nothing.
class FrameIntake {
 public:
  explicit FrameIntake(const StampSettings& settings) : settings_(settings) {}

  /// `dequeued_at`: when the buffer was taken from the source. The frame keeps the buffer's loan. Every frame
  /// is passed on, for the live picture; one with an impossible stamp is refused for painting by
  /// FrameMatcher.
  CapturedFrame accept(const FrameBuffer& buffer, Instant dequeued_at) noexcept;

  const CameraHealth& health() const noexcept { return health_; }

 private:
  void count(std::uint32_t sequence) noexcept;

  StampSettings settings_;
  StampCheck stamps_;
  FreezeDetector freeze_;
  std::uint32_t last_sequence_ = 0;
  CameraHealth health_;
};

}  // namespace orcart
