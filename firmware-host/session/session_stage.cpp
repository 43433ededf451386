// The render thread's half is a copy; the session thread's half is the disk.
#include "firmware-host/session/session_stage.hpp"

namespace orcart {

StepReport SessionStage::step(Instant) noexcept {
  const auto written = writer_.write_pending(slots_);
  failing_.store(!written, std::memory_order_relaxed);          // a flag alone, no partner
  unwritten_.store(writer_.lost(), std::memory_order_relaxed);  // a count alone, no partner
  if (!written) {
    failures_.fetch_add(1, std::memory_order_relaxed);  // a count alone, no partner
    last_error_ = written.error().message;
    return {.worked = true};
  }
  kept_.fetch_add(*written, std::memory_order_relaxed);  // a count alone, no partner
  return {.worked = *written > 0, .items = static_cast<std::uint32_t>(*written)};
}

void SessionStage::keep(const CapturedFrame& frame, const CaptureRecord& record) noexcept {
  (void)slots_.offer(frame, {.unit = record.unit,
                             .streaming = record.streaming,
                             .edge_at = record.edge_at,
                             .matched_at = record.matched_at,
                             .painted_at = record.painted_at,
                             .X_MC = record.X_MC,
                             .turn_rad = record.turn_rad,
                             .pose_kind = record.pose_kind,
                             .pose_distance = record.pose_distance,
                             .velocity = record.velocity});
}

}  // namespace orcart
