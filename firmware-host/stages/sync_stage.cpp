// Every frame is ordered to be shown at once; only painting waits for its poses.
#include "firmware-host/stages/sync_stage.hpp"

#include <cmath>
#include <numbers>

namespace orcart {

StepReport SyncStage::step(Instant now) noexcept {
  StepReport report;
  if (settings_.matcher.turn == TurnSource::encoder) hear_encoder();
  report.items = take_poses(now) + take_presses() + take_frames(now);
  decide(now);
  tell_scope(now);
  report.worked = report.items > 0;
  return report;
}

// The news first: they vouch for angles that are in the lane by then.
void SyncStage::hear_encoder() noexcept {
  EncoderNews news;
  if (!lanes_.encoder_news.take(news)) return;
  EncoderAngle angle;
  const std::size_t waiting = lanes_.encoder_angles.size();
  for (std::size_t i = 0; i < waiting && lanes_.encoder_angles.try_pop(angle); ++i) encoder_turn_.push(angle);
  encoder_turn_.heard(news.heard_until, news.connected);
}

std::uint32_t SyncStage::take_poses(Instant now) noexcept {
  std::uint32_t count = 0;
  PoseSample sample;
  const std::size_t waiting = lanes_.poses.size() + (unheard_ ? 1 : 0);
  for (; count < waiting; ++count) {
    if (unheard_) {
      sample = *unheard_;
    } else if (!lanes_.poses.try_pop(sample)) {
      break;
    }
    const bool waits = settings_.matcher.turn == TurnSource::encoder &&
                       !encoder_turn_.decided(sample.measured_at) &&
                       now < sample.arrived_at + kLongestHearing;
    if (waits) {
      unheard_ = sample;
      break;
    }
    unheard_.reset();
    sample.turn_rad = turn_at(sample);
    (void)history_.push(sample);
  }
  return count;
}

std::optional<double> SyncStage::turn_at(const PoseSample& sample) const noexcept {
  if (settings_.matcher.turn == TurnSource::marker) return turn_by_markers(sample);
  if (settings_.matcher.turn == TurnSource::encoder) return encoder_turn_.at(sample.measured_at);
  return std::nullopt;
}

std::optional<double> SyncStage::turn_by_markers(const PoseSample& sample) const noexcept {
  if (sample.scope != ToolState::seen || sample.second != ToolState::seen) return std::nullopt;
  const MarkedTurn turn =
      turn_of(*settings_.scope.turning, sample.X_TS.rotation.transpose() * sample.X_TL.rotation);
  return turn.swing_rad <= kMostSwing_rad ? std::optional(turn.turn_rad) : std::nullopt;
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
    if (settings_.matcher.turn == TurnSource::notch || check_)
      frame.notch_turn_rad = notch_turn_.follow(frame.mid_exposure(), frame.notch_turn_rad);
    (void)lanes_.orders.try_push({.kind = PaintOrderKind::show, .frame = frame});
    if (const auto refused = matcher_.add(frame)) select(*refused, now);
  }
  return count;
}

void SyncStage::decide(Instant now) noexcept {
  for (std::size_t i = 0; i < FrameMatcher::kMostHeld; ++i) {
    auto matched = matcher_.next(now, history_, selector_.edge_grace());
    if (!matched) break;
    if (check_) compare_with_notch(*matched);
    if (check_ && check_->differs() && matched->refusal == Refusal::none)
      matched->refusal = Refusal::turn_mismatch;
    select(*matched, now);
  }
  while (const auto failed = selector_.next_failed(now)) fail(*failed, failed->reason);  // bound: as may wait
}

// What is followed goes on being compared while nothing is painted: a turn that is put right paints again.
void SyncStage::compare_with_notch(const MatchedFrame& matched) noexcept {
  const CapturedFrame& frame = matched.frame;
  if (!frame.notch_turn_rad) return;
  if (settings_.matcher.turn == TurnSource::encoder && !encoder_turn_.zero_known()) find_zero(frame);
  if (matched.pose.may_paint())
    check_->compare(frame.mid_exposure(), matched.turn_rad, *frame.notch_turn_rad);
  const double off_deg = check_->difference_rad() * 180 / std::numbers::pi;
  mismatch_deg_.store(check_->differs() ? static_cast<int>(std::lround(off_deg)) : 0,
                      std::memory_order_relaxed);
}

void SyncStage::find_zero(const CapturedFrame& frame) noexcept {
  const Instant at = frame.mid_exposure() + settings_.matcher.tracker_against_video;
  const auto angle = encoder_turn_.angle_at(at);
  if (!angle) return;
  if (angle->run != zero_run_) zero_check_.forget();
  zero_run_ = angle->run;
  zero_check_.compare(frame.mid_exposure(), angle->angle_rad, *frame.notch_turn_rad);
  if (const auto zero = zero_check_.steady_rad(kZeroWithin_rad)) encoder_turn_.set_zero(zero_run_, *zero);
}

void SyncStage::select(const MatchedFrame& matched, Instant now) noexcept {
  const auto request = selector_.claim(matched);
  if (request &&
      lanes_.selected.try_push({.matched = matched,
                                .request = *request,
                                .decided_at = now,
                                .velocity = history_.velocity(matched.frame.mid_exposure() +
                                                              settings_.matcher.tracker_against_video)}))
    return;
  (void)lanes_.orders.try_push({.kind = PaintOrderKind::release, .frame = matched.frame});
}

void SyncStage::order(PaintOrderKind kind, const CaptureRequest& request) noexcept {
  (void)lanes_.orders.try_push({.kind = kind, .request = request});
}

void SyncStage::fail(const CaptureRequest& request, Refusal why) noexcept {
  (void)lanes_.orders.try_push({.kind = PaintOrderKind::fail, .request = request, .refusal = why});
}

TurnLack SyncStage::lack_of_turn(Instant now, const PoseAnswer& pose) const noexcept {
  const TurnSource source = settings_.matcher.turn;
  if (check_ && check_->differs()) return TurnLack::mismatch;
  if (source == TurnSource::told) return TurnLack::none;
  if (source == TurnSource::notch) return notch_turn_.now(now) ? TurnLack::none : TurnLack::notch;
  if (source == TurnSource::encoder && !encoder_turn_.connected()) return TurnLack::encoder;
  if (source == TurnSource::encoder && !encoder_turn_.zero_known())
    return check_ ? TurnLack::notch : TurnLack::encoder_zero;
  if (pose.kind != PoseKind::none || !history_.lacks_turn_around(now)) return TurnLack::none;
  return source == TurnSource::marker ? TurnLack::second_marker : TurnLack::encoder;
}

void SyncStage::tell_scope(Instant now) noexcept {
  ScopeNow scope{.at = now, .pose = history_.at(now)};
  scope.turn_rad =
      settings_.matcher.turn == TurnSource::notch ? notch_turn_.now(now).value_or(0) : scope.pose.turn_rad;
  scope.turn_lack = lack_of_turn(now, scope.pose);
  scope.mismatch_deg = mismatch_deg();
  if (scope.turn_lack != TurnLack::none) scope.pose.kind = PoseKind::none;
  if (scope.pose.kind != PoseKind::none)
    scope.X_MC = settings_.X_MR * scope.pose.X_RS * optics_at(settings_.scope, scope.turn_rad).X_SC;
  lanes_.scope_now.post(scope);
}

}  // namespace orcart
