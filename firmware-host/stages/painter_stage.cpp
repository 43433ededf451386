// Orders are handled in their order; buffers and patch slots go home as soon as nothing needs them.
#include "firmware-host/stages/painter_stage.hpp"

namespace orcart {

PainterStage::PainterStage(const Parts& parts)
    : painter_(parts.painter),
      clock_(parts.clock),
      lanes_(parts.lanes),
      patches_(parts.patches),
      captures_(parts.captures),
      errors_(parts.errors),
      sink_(parts.sink),
      context_(parts.context),
      holds_(parts.buffer_count, 0) {}

void PainterStage::enter_thread() noexcept {
  if (context_ != nullptr) (void)context_->make_current();
}

void PainterStage::leave_thread() noexcept {
  if (context_ != nullptr) context_->release_current();
}

StepReport PainterStage::step(Instant now) noexcept {
  StepReport report;
  if (is_carried_) {
    go_on();
    report.items = 1;
  }
  PaintOrder order;
  const std::size_t waiting = lanes_.orders.size();  // bound: what had come when the step began
  for (std::size_t i = 0; i < waiting && !is_carried_ && lanes_.orders.try_pop(order); ++i) {
    handle(order, now);
    ++report.items;
  }
  upload_newest();
  report.worked = report.items > 0;
  report.carried = is_carried_;
  return report;
}

void PainterStage::handle(const PaintOrder& order, Instant now) noexcept {
  switch (order.kind) {
    case PaintOrderKind::show:
      show(order.frame);
      break;
    case PaintOrderKind::paint:
      paint(order, now);
      break;
    case PaintOrderKind::release:
      done_with(order.frame.buffer);
      break;
    case PaintOrderKind::acknowledge:
      state_.acknowledge_pending = true;
      state_.acknowledged_unit = order.request.unit;
      state_.streaming = order.request.streaming;
      break;
    case PaintOrderKind::cancel:
      state_.acknowledge_pending = false;
      cancelled_unit_ = order.request.unit;
      if (unit_count_ > 0 && units_[unit_count_ - 1].number == order.request.unit) take_back(now);
      break;
    case PaintOrderKind::undo:
      take_back(now);
      break;
    case PaintOrderKind::stream_end:
      end_stream(order.request.unit, now);
      break;
    case PaintOrderKind::fail:
      fail(order, now);
      break;
    case PaintOrderKind::warn:
      state_.warned_at = now;
      break;
  }
}

// A newer picture replaces the one in the inset; the frame itself is held twice: as newest, and for its
// second order.
void PainterStage::show(const CapturedFrame& frame) noexcept {
  if (have_newest_) done_with(newest_.buffer);
  newest_ = frame;
  have_newest_ = true;
  upload_due_ = true;
  holds_[frame.buffer] = 2;
}

// Of a view in parts, the painter paints with the last one. What was taken back while the mapper still had it
// comes after the order that took it back.
void PainterStage::paint(const PaintOrder& order, Instant now) noexcept {
  const bool last = patches_[order.patch].last_part;
  if (order.request.unit == cancelled_unit_ || order.request.unit == undone_unit_) {
    (void)lanes_.patches_home.try_push(order.patch);
    if (last) done_with(order.frame.buffer);
    return;
  }
  if (!painter_.upload(order.frame.image)) {  // else the picture before it would be painted
    (void)lanes_.patches_home.try_push(order.patch);
    if (last) refuse(order, now);
    return;
  }
  upload_due_ = have_newest_;  // the inset goes back to the newest picture
  painter_.set_turn(order.turn_rad);
  if (last && errors_ != nullptr) painter_.set_view_error(errors_->at(order.X_MC));
  const PaintReport report = painter_.paint(patches_[order.patch], order.request.unit);
  (void)lanes_.patches_home.try_push(order.patch);
  if (!last) return;
  is_carried_ = report.carried;
  carried_ = order;
  if (!report.carried) painted(order, report.painted);
}

void PainterStage::refuse(const PaintOrder& order, Instant now) noexcept {
  PaintOrder refused = order;
  refused.refusal = Refusal::no_frame;
  fail(refused, now);
  done_with(order.frame.buffer);
}

void PainterStage::go_on() noexcept {
  (void)painter_.upload(carried_.frame.image);  // was taken once
  upload_due_ = have_newest_;
  is_carried_ = painter_.paint_more().carried;
  if (!is_carried_) painted(carried_, true);
}

// A picture that shows no surface, as of a calibration board, is a capture all the same.
void PainterStage::painted(const PaintOrder& order, bool on_surface) noexcept {
  const bool new_unit = unit_count_ == 0 || units_[unit_count_ - 1].number != order.request.unit;
  if (new_unit) {
    if (unit_count_ == units_.size()) {
      for (std::size_t i = 1; i < units_.size(); ++i) units_[i - 1] = units_[i];
      --unit_count_;
    }
    units_[unit_count_++] = {.number = order.request.unit};
    ++state_.captures;
  }
  Unit& unit = units_[unit_count_ - 1];
  unit.on_surface = unit.on_surface || on_surface;
  ++state_.version;
  state_.acknowledge_pending = false;
  state_.last_refusal = Refusal::none;
  state_.failed_at = Instant{};
  CaptureRecord record{.unit = order.request.unit,
                       .frame_sequence = order.frame.sequence,
                       .streaming = order.request.streaming,
                       .edge_at = order.request.edge_at,
                       .mid_exposure = order.frame.mid_exposure(),
                       .matched_at = order.matched_at,
                       .mapped_at = order.mapped_at,
                       .painted_at = clock_.now(),
                       .X_MC = order.X_MC,
                       .turn_rad = order.turn_rad,
                       .pose_kind = order.pose_kind,
                       .pose_distance = order.pose_distance,
                       .velocity = order.velocity};
  captures_.append(record);
  if (sink_ != nullptr) sink_->keep(order.frame, record);
  done_with(order.frame.buffer);
}

void PainterStage::fail(const PaintOrder& order, Instant now) noexcept {
  state_.acknowledge_pending = false;
  state_.streaming = false;
  state_.last_refusal = order.refusal;
  state_.failed_at = now;
  ++state_.refused;
  failed_unit_ = order.request.unit;
  captures_.append({.unit = order.request.unit, .refusal = order.refusal, .edge_at = order.request.edge_at});
}

// A press that was refused is acknowledged anew as it turns into a stream; where nothing of that was painted
// either, the failure is what stays.
void PainterStage::end_stream(std::uint32_t unit, Instant now) noexcept {
  state_.streaming = false;
  state_.acknowledge_pending = false;
  const bool painted = unit_count_ > 0 && units_[unit_count_ - 1].number == unit;
  if (painted || failed_unit_ != unit || state_.last_refusal == Refusal::none) return;
  state_.failed_at = now;
}

void PainterStage::take_back(Instant now) noexcept {
  if (unit_count_ == 0 || (units_[unit_count_ - 1].on_surface && !painter_.undo())) return;
  const std::uint32_t unit = units_[--unit_count_].number;
  undone_unit_ = unit;
  const std::size_t records = captures_.size();
  for (std::size_t i = records; i > 0 && captures_.at(i - 1).unit >= unit;
       --i) {  // bound: the ledger's capacity
    if (captures_.at(i - 1).unit == unit) captures_.at(i - 1).undone = true;
  }
  if (state_.captures > 0) --state_.captures;
  ++state_.version;
  state_.undone_at = now;
  if (sink_ != nullptr) sink_->undone(unit);
}

void PainterStage::done_with(std::uint32_t buffer) noexcept {
  if (holds_[buffer] > 0 && --holds_[buffer] == 0) (void)lanes_.frames_home.try_push(buffer);
}

void PainterStage::upload_newest() noexcept {
  if (!upload_due_) return;
  upload_due_ = false;
  if (!painter_.upload(newest_.image)) return;  // the one before stays, and grows old
  if (state_.newest.sequence == newest_.sequence && state_.newest.dequeued_at == newest_.dequeued_at) return;
  state_.newest = {.sequence = newest_.sequence,
                   .mid_exposure = newest_.mid_exposure(),
                   .dequeued_at = newest_.dequeued_at,
                   .uploaded_at = clock_.now()};
  state_.newest_exposed = newest_.exposure_end;
  state_.newest_is_new = true;
}

}  // namespace orcart
