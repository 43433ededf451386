// Takes filled buffers from the camera, says when they were exposed, and gives empty ones back. Thread:
// camera. Rate: when a frame comes. Budget: topology, row "camera".
#pragma once

#include "board/ports/frame_source.hpp"
#include "firmware-host/stages/lanes.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/stage.hpp"

namespace orcart {

/// What the driver's stamp marks. It is configuration: V4L2 flags often do not say.
enum class FrameStamp : std::uint8_t { start_of_exposure, end_of_exposure };

struct CameraStageSettings {
  FrameStamp stamp = FrameStamp::end_of_exposure;
  Nanos exposure{};  ///< where the driver does not tell it
};

class CameraStage final : public Stage {
 public:
  CameraStage(FrameSource& source, const Clock& clock, const CameraStageSettings& settings, Lanes& lanes)
      : source_(source), clock_(clock), settings_(settings), lanes_(lanes) {}

  std::string_view name() const noexcept override { return "camera"; }
  StepReport step(Instant now) noexcept override;

 private:
  CapturedFrame stamped(const FrameBuffer& buffer) const noexcept;
  void count(const FrameBuffer& buffer) noexcept;

  FrameSource& source_;
  const Clock& clock_;
  CameraStageSettings settings_;
  Lanes& lanes_;
  CameraNews news_;
  std::uint32_t last_sequence_ = 0;
  bool any_ = false;
};

}  // namespace orcart
