// A ring of at most four frames; only the oldest is looked at, the others are younger and cannot be decided
// before it.
#include "realtime/sync/frame_matcher.hpp"

namespace orcart {

std::optional<MatchedFrame> FrameMatcher::add(const CapturedFrame& frame) noexcept {
  const Refusal stamps = stamps_.check(frame);
  if (stamps != Refusal::none) return MatchedFrame{.frame = frame, .pose = {}, .refusal = stamps};
  std::optional<MatchedFrame> evicted;
  if (size_ == kMostHeld) evicted = MatchedFrame{.frame = pop(), .pose = {}, .refusal = Refusal::queue_full};
  held_[(first_ + size_) % kMostHeld] = frame;
  ++size_;
  return evicted;
}

std::optional<MatchedFrame> FrameMatcher::next(Instant now, const PoseHistory& poses,
                                               Nanos edge_grace) noexcept {
  if (size_ == 0) return std::nullopt;
  const Instant mid_exposure = held_[first_].mid_exposure();
  const Instant looked_up = mid_exposure + settings_.tracker_against_video;
  const bool decided = poses.decided(looked_up);
  const bool waited = now >= mid_exposure + settings_.longest_wait;
  const bool ready = decided && now >= mid_exposure + edge_grace;
  if (!ready && !waited) return std::nullopt;

  MatchedFrame answer{.frame = pop(), .pose = poses.at(looked_up), .refusal = Refusal::none};
  const bool by_notch = settings_.turn == TurnSource::notch;
  answer.turn_rad = by_notch ? answer.frame.notch_turn_rad.value_or(0) : answer.pose.turn_rad;
  if (!decided)
    answer.refusal = Refusal::too_late;
  else if (!answer.pose.may_paint())
    answer.refusal = poses.lacks_turn_around(looked_up) ? Refusal::turn_unknown
                     : poses.sampled_around(looked_up)  ? Refusal::tool_unseen
                                                        : Refusal::no_pose;
  else if (by_notch && !answer.frame.notch_turn_rad)
    answer.refusal = Refusal::turn_unknown;
  return answer;
}

CapturedFrame FrameMatcher::pop() noexcept {
  const CapturedFrame frame = held_[first_];
  first_ = (first_ + 1) % kMostHeld;
  --size_;
  return frame;
}

}  // namespace orcart
