// Every frame is ordered to be shown at once; only painting waits for its poses.
#include "firmware-host/stages/sync_stage.hpp"

namespace orcart {

StepReport SyncStage::step(Instant now) noexcept {
  StepReport report;
  report.items = take_poses() + take_presses() + take_frames(now);
  decide(now);
  tell_scope(now);
  report.worked = report.items > 0;
  return report;
}

std::uint32_t SyncStage::take_poses() noexcept {
  std::uint32_t count = 0;
  PoseSample sample;
  for (const std::size_t waiting = lanes_.poses.size(); count < waiting && lanes_.poses.try_pop(sample);
       ++count) {
    (void)history_.push(sample);
  }
  return count;
}

std::uint32_t SyncStage::take_presses() noexcept {
  std::uint32_t count = 0;
  PedalEvent event;
  for (const std::size_t waiting = lanes_.pedal.size(); count < waiting && lanes_.pedal.try_pop(event);
       ++count) {
    const bool streaming = event.kind == PedalEventKind::stream_begin;
    const CaptureRequest request{.unit = event.unit, .edge_at = event.at, .streaming = streaming};
    if (settings_.painting_blocked &&
        (event.kind == PedalEventKind::capture || event.kind == PedalEventKind::stream_begin)) {
      fail(request, Refusal::blocked);
      continue;
    }
    switch (event.kind) {
      case PedalEventKind::capture:
        if (selector_.request(request)) {
          order(PaintOrderKind::acknowledge, request);
        } else {
          fail(request, Refusal::queue_full);
        }
        break;
      case PedalEventKind::cancel:
        (void)selector_.cancel(event.unit);
        order(PaintOrderKind::cancel, request);
        break;
      case PedalEventKind::undo:
        order(PaintOrderKind::undo, request);
        break;
      case PedalEventKind::stream_begin:
        selector_.begin_stream(request);
        order(PaintOrderKind::acknowledge, request);
        break;
      case PedalEventKind::stream_end:
        selector_.end_stream(event.at);
        order(PaintOrderKind::stream_end, request);
        break;
      case PedalEventKind::stuck:
      case PedalEventKind::lost_edge:
        order(PaintOrderKind::warn, request);
        break;
    }
  }
  return count;
}

std::uint32_t SyncStage::take_frames(Instant now) noexcept {
  std::uint32_t count = 0;
  CapturedFrame frame;
  for (const std::size_t waiting = lanes_.frames.size(); count < waiting && lanes_.frames.try_pop(frame);
       ++count) {
    (void)lanes_.orders.try_push({.kind = PaintOrderKind::show, .frame = frame});
    if (const auto refused = matcher_.add(frame)) select(*refused, now);
  }
  return count;
}

void SyncStage::decide(Instant now) noexcept {
  for (std::size_t i = 0; i < FrameMatcher::kMostHeld; ++i) {
    const auto matched = matcher_.next(now, history_, selector_.edge_grace());
    if (!matched) break;
    select(*matched, now);
  }
  while (const auto failed = selector_.next_failed(now)) fail(*failed, failed->reason);  // bound: as may wait
}

void SyncStage::select(const MatchedFrame& matched, Instant now) noexcept {
  const auto request = selector_.claim(matched);
  if (request && lanes_.selected.try_push({.matched = matched, .request = *request, .decided_at = now}))
    return;
  (void)lanes_.orders.try_push({.kind = PaintOrderKind::release, .frame = matched.frame});
}

void SyncStage::order(PaintOrderKind kind, const CaptureRequest& request) noexcept {
  (void)lanes_.orders.try_push({.kind = kind, .request = request});
}

void SyncStage::fail(const CaptureRequest& request, Refusal why) noexcept {
  (void)lanes_.orders.try_push({.kind = PaintOrderKind::fail, .request = request, .refusal = why});
}

void SyncStage::tell_scope(Instant now) noexcept {
  ScopeNow scope{.at = now, .pose = history_.at(now)};
  if (scope.pose.kind != PoseKind::none) scope.X_MC = settings_.X_MR * scope.pose.X_RS * settings_.X_SC;
  lanes_.scope_now.post(scope);
}

}  // namespace orcart
