// Exposure from the stamp, gaps from the sequence, freezing from the pixels.
#include "firmware-host/camera/frame_intake.hpp"

namespace orcart {

CapturedFrame FrameIntake::accept(const FrameBuffer& buffer, Instant dequeued_at) noexcept {
  const Exposure exposure = exposure_of(buffer, dequeued_at, settings_);
  const CapturedFrame frame{.buffer = buffer.index,
                            .sequence = buffer.sequence,
                            .image = buffer.image,
                            .exposure_start = exposure.start,
                            .exposure_end = exposure.end,
                            .dequeued_at = dequeued_at};
  count(buffer.sequence);
  (void)stamps_.check(frame);
  health_.stamps_faulty = stamps_.faulty();
  health_.newest = sample_picture(buffer.image);
  if (health_.newest.known) (void)freeze_.see(buffer.sequence, dequeued_at, health_.newest.checksum);
  health_.frozen = freeze_.frozen();
  health_.repeats = freeze_.repeats();
  return frame;
}

// The sequence wraps at 2^32; half of that forward or back tells a gap from a restart.
void FrameIntake::count(std::uint32_t sequence) noexcept {
  const auto step = static_cast<std::int32_t>(sequence - last_sequence_);
  if (health_.frames > 0 && step > 1) health_.lost += static_cast<std::uint32_t>(step - 1);
  if (health_.frames > 0 && step < 1) ++health_.restarts;
  last_sequence_ = sequence;
  ++health_.frames;
}

}  // namespace orcart
