// Between two edges the line stands still, so what time brings about follows from the stamps alone.
#include "firmware-host/pedal/pedal_gestures.hpp"

#include <algorithm>

namespace orcart {

void PedalGestures::edge(const PedalEdge& edge) noexcept {
  advance(edge.at);
  const bool pressed = edge.kind == EdgeKind::pressed;
  const bool lost = have_edge_ && (edge.sequence != sequence_ + 1 || pressed == line_pressed_);
  have_edge_ = true;
  sequence_ = edge.sequence;
  line_pressed_ = pressed;
  line_changed_at_ = edge.at;
  if (lost)
    ignore(PedalEventKind::lost_edge, edge.at);
  else if (pressed && state_ == State::up)
    press(edge.at);
}

void PedalGestures::advance(Instant now) noexcept {
  if (state_ == State::up) return;
  if (!line_pressed_) {
    if (now >= release_due()) release(line_changed_at_);
    return;
  }
  if (state_ == State::down && now >= pressed_at_ + settings_.hold) {
    state_ = State::streaming;
    emit(PedalEventKind::stream_begin, pressed_at_);
  }
  if (state_ != State::ignoring && now >= pressed_at_ + settings_.stuck)
    ignore(PedalEventKind::stuck, pressed_at_ + settings_.stuck);
}

Instant PedalGestures::release_due() const noexcept {
  return std::max(line_changed_at_ + settings_.release_stable, pressed_at_ + settings_.lock_out);
}

Instant PedalGestures::due() const noexcept {
  if (state_ == State::up) return Instant::max();
  if (!line_pressed_) return release_due();
  if (state_ == State::down) return pressed_at_ + settings_.hold;
  return state_ == State::ignoring ? Instant::max() : pressed_at_ + settings_.stuck;
}

void PedalGestures::press(Instant at) noexcept {
  pressed_at_ = at;
  if (captured_at_ && at - *captured_at_ < settings_.second_press) {
    captured_at_.reset();
    state_ = State::down_idle;
    emit(PedalEventKind::cancel, at);
    emit(PedalEventKind::undo, at);
    return;
  }
  captured_at_ = at;
  state_ = State::down;
  ++unit_;
  emit(PedalEventKind::capture, at);
}

void PedalGestures::release(Instant at) noexcept {
  if (state_ == State::streaming) emit(PedalEventKind::stream_end, at);
  state_ = State::up;
}

void PedalGestures::ignore(PedalEventKind why, Instant at) noexcept {
  if (state_ == State::streaming) emit(PedalEventKind::stream_end, at);
  emit(why, at);
  state_ = State::ignoring;
  captured_at_.reset();
}

std::optional<PedalEvent> PedalGestures::next() noexcept {
  if (size_ == 0) return std::nullopt;
  const PedalEvent event = events_[first_];
  first_ = (first_ + 1) % events_.size();
  --size_;
  return event;
}

// One call emits at most five events; a caller that does not take them loses the newest.
void PedalGestures::emit(PedalEventKind kind, Instant at) noexcept {
  if (size_ == events_.size()) return;
  events_[(first_ + size_) % events_.size()] = {.kind = kind, .unit = unit_, .at = at};
  ++size_;
}

}  // namespace orcart
