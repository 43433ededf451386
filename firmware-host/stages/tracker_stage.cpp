// Both tools must come from one device frame to make a complete sample.
#include "firmware-host/stages/tracker_stage.hpp"

#include "firmware-host/tracker/ndi/words.hpp"

namespace orcart {

StepReport TrackerStage::step(Instant now) noexcept {
  const DriverReport report = driver_.step(now);
  if (report.health != TrackerHealth::live || now >= state_due_) tell_state(report.trouble, now);
  if (driver_.bumped()) {
    news_.bumped_at = now;
    driver_.forget_alerts();
  }
  if (report.new_reply) {
    news_.infrared = (driver_.reply().system_status & ndi::kTooMuchInfrared) != 0;
    const PoseSample sample = sample_of(driver_.reply());
    (void)lanes_.poses.try_push(sample);
    news_.last_reply = sample.arrived_at;
    news_.scope = sample.scope;
    news_.reference = sample.reference;
    if (sample.complete()) news_.last_complete = sample.arrived_at;
  }
  lanes_.tracker_news.post(news_);
  return {.worked = report.worked, .items = report.new_reply ? 1u : 0u};
}

void TrackerStage::tell_state(TrackerTrouble trouble, Instant now) noexcept {
  news_.refuses = refuses(trouble);
  state_.store(driver_.state(), std::memory_order_relaxed);
  state_due_ = now + kStateEvery;
}

/// The fit begins anew where the counter runs at another rate than it was laid for.
void TrackerStage::count(std::uint32_t device_frame, Instant arrived_at) noexcept {
  const double assumed_hz = driver_.counter_hz();
  const bool other_device = assumed_hz != assumed_hz_;
  if (other_device) counter_ = CounterRate(assumed_hz);
  assumed_hz_ = assumed_hz;
  if (!counter_.observe(device_frame, arrived_at) && !other_device) return;
  fit_settings_.rate_hz = counter_.hz();
  fit_ = ClockFit(fit_settings_);
}

PoseSample TrackerStage::sample_of(const TrackerReply& reply) noexcept {
  // A reply with a missing tool is shorter and so comes sooner: what the line takes is taken off each.
  const Instant arrived_at = reply.arrived_at - reply.wire_time;
  count(reply.device_frame, arrived_at);
  (void)fit_.observe(reply.device_frame, arrived_at);
  const ToolReading &scope = reply.tools[0], &reference = reply.tools[1];
  PoseSample sample{.measured_at = fit_.host_time(reply.device_frame),
                    .arrived_at = reply.arrived_at,
                    .device_frame = reply.device_frame,
                    .scope = scope.state,
                    .reference = reference.state,
                    .X_TS = pose_from_quaternion<T, S>(scope.quaternion, scope.translation_mm),
                    .X_TR = pose_from_quaternion<T, R>(reference.quaternion, reference.translation_mm),
                    .scope_error_mm = scope.error_mm,
                    .reference_error_mm = reference.error_mm};
  if (reply.tool_count < 2) sample.reference = ToolState::unseen;
  const bool one_frame =
      scope.device_frame == reply.device_frame && reference.device_frame == reply.device_frame;
  if (sample.complete() && !one_frame) sample.reference = ToolState::doubtful;
  if (reply.tool_count > 2 && reply.tools[2].device_frame == reply.device_frame) {
    sample.second = reply.tools[2].state;
    sample.X_TL = pose_from_quaternion<T, L>(reply.tools[2].quaternion, reply.tools[2].translation_mm);
  }
  return sample;
}

}  // namespace orcart
