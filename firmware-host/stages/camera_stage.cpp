// Buffers that came home go back first, so that the driver has somewhere to put the next frame.
#include "firmware-host/stages/camera_stage.hpp"

namespace orcart {

StepReport CameraStage::step(Instant) noexcept {
  StepReport report;
  std::uint32_t home = 0;
  const std::uint32_t buffers = source_.buffer_count();
  for (std::uint32_t i = 0; i < buffers && lanes_.frames_home.try_pop(home); ++i) source_.give_back(home);
  for (std::uint32_t i = 0; i < buffers; ++i) {
    const auto buffer = source_.take();
    if (!buffer) {
      if (buffer.error() == PortFault::damaged) ++news_.damaged;
      if (buffer.error() == PortFault::disconnected) news_.connected = false;
      if (buffer.error() != PortFault::damaged) break;
      continue;
    }
    news_.connected = true;
    count(*buffer);
    const CapturedFrame frame = stamped(*buffer);
    news_.last_frame = frame.exposure_end;
    if (!lanes_.frames.try_push(frame)) source_.give_back(buffer->index);
    ++report.items;
  }
  report.worked = report.items > 0;
  lanes_.camera_news.post(news_);
  return report;
}

CapturedFrame CameraStage::stamped(const FrameBuffer& buffer) const noexcept {
  const Nanos exposure = buffer.exposure > Nanos{0} ? buffer.exposure : settings_.exposure;
  const bool at_start = settings_.stamp == FrameStamp::start_of_exposure;
  const Instant start = at_start ? buffer.stamp : buffer.stamp - exposure;
  return {.buffer = buffer.index,
          .sequence = buffer.sequence,
          .image = buffer.image,
          .exposure_start = start,
          .exposure_end = start + exposure,
          .dequeued_at = clock_.now()};
}

void CameraStage::count(const FrameBuffer& buffer) noexcept {
  if (any_ && buffer.sequence > last_sequence_ + 1)
    news_.sequence_gaps += buffer.sequence - last_sequence_ - 1;
  last_sequence_ = buffer.sequence;
  any_ = true;
}

}  // namespace orcart
