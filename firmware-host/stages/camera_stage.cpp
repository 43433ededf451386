// Buffers that came home go back first, so that the driver has somewhere to put the next frame.
#include "firmware-host/stages/camera_stage.hpp"

#include <algorithm>

namespace orcart {

StepReport CameraStage::step(Instant) noexcept {
  StepReport report;
  std::uint32_t home = 0;
  const std::uint32_t buffers = source_.buffer_count();
  for (std::uint32_t i = 0; i < buffers && lanes_.frames_home.try_pop(home); ++i) source_.give_back(home);
  for (std::uint32_t i = 0; i < buffers; ++i) {
    const auto buffer = source_.take();
    if (!buffer) {
      if (buffer.error() != PortFault::damaged) {
        recover(buffer.error());
        break;
      }
      note_damaged();
      continue;
    }
    news_.connected = true;
    fault_.clear();
    damaged_since_ = Instant::max();
    retry_at_ = Instant{};
    retry_after_ = kFirstRetry;
    CapturedFrame frame = intake_.accept(*buffer, clock_.now());
    if (notch_ != nullptr) frame.notch_turn_rad = notch_->turn_in(frame.image);
    news_.last_frame = frame.exposure_end;
    news_.last_dequeued = frame.dequeued_at;
    if (!lanes_.frames.try_push(frame)) source_.give_back(buffer->index);
    ++report.items;
  }
  report.worked = report.items > 0;
  news_.frozen = intake_.health().frozen;
  news_.stamps_wrong = intake_.health().stamps_faulty;
  lanes_.camera_news.post(news_);
  return report;
}

// Nothing is restarted: the stream runs, and only whoever looks at cable or camera can mend what it brings.
void CameraStage::note_damaged() noexcept {
  ++news_.damaged;
  damaged_since_ = std::min(damaged_since_, clock_.now());
  if (clock_.now() - damaged_since_ >= kDamagedFor) fault_.set(PortFault::damaged);
}

void CameraStage::recover(PortFault fault) noexcept {
  if (fault == PortFault::nothing_yet) return;
  news_.connected = false;
  fault_.set(fault);
  if (clock_.now() < retry_at_) return;
  (void)source_.recover();
  retry_at_ = clock_.now() + retry_after_;
  retry_after_ = std::min<Nanos>(2 * retry_after_, kLastRetry);
}

}  // namespace orcart
