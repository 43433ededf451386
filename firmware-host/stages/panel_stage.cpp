// One panel picture: what is known of the sources becomes words and a view, and every picture's flip is
// traced back to the frame and the captures it showed.
#include "firmware-host/stages/panel_stage.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace orcart {

namespace {

std::string_view words_for(Refusal refusal) {
  switch (refusal) {
    case Refusal::tool_unseen:
      return "CAPTURE FAILED: the tracker did not see the tool";
    case Refusal::no_pose:
      return "CAPTURE FAILED: no pose around the picture";
    case Refusal::turn_unknown:
      return "CAPTURE FAILED: nothing tells how far the scope is turned";
    case Refusal::turn_mismatch:
      return "CAPTURE FAILED: the notch says another turn";
    case Refusal::too_late:
      return "CAPTURE FAILED: the pose came too late";
    case Refusal::no_frame:
      return "CAPTURE FAILED: no picture from the camera";
    case Refusal::queue_full:
      return "CAPTURE FAILED: too many pictures wait for their pose";
    case Refusal::stamp_in_future:
    case Refusal::stamp_backwards:
      return "CAPTURE FAILED: the camera's time stamps are wrong";
    case Refusal::blocked:
      return "CAPTURE FAILED: painting is blocked";
    case Refusal::none:
      break;
  }
  return "";
}

std::string_view words_for(TurnLack lack) {
  switch (lack) {
    case TurnLack::second_marker:
      return "TURN NOT KNOWN: clear the second marker's line of sight";
    case TurnLack::notch:
      return "TURN NOT KNOWN: no notch in the picture; light its rim";
    case TurnLack::encoder:
      return "TURN NOT KNOWN: no encoder; check its cable";
    case TurnLack::encoder_zero:
      return "TURN NOT KNOWN: tell it (orcart turn) and start again";
    case TurnLack::mismatch:
    case TurnLack::none:
      break;
  }
  return "";
}

/// What a person should suspect where the notch says another turn.
const char* suspect_for(TurnSource source) {
  switch (source) {
    case TurnSource::marker:
      return "marker slipped?";
    case TurnSource::encoder:
      return "encoder slipped?";
    case TurnSource::told:
    case TurnSource::notch:
      break;
  }
  return "head turned?";
}

Freshness shown_as(Liveness liveness) {
  switch (liveness) {
    case Liveness::live:
      return Freshness::live;
    case Liveness::stale:
      return Freshness::stale;
    case Liveness::lost:
      break;
  }
  return Freshness::lost;
}

constexpr Nanos kBumpShownFor = 30s;
constexpr Nanos kLossShownFor = 30s;
constexpr Nanos kScopeShownFor = 50ms;
constexpr Nanos kNoticeTime = 2s;

}  // namespace

PanelStage::PanelStage(const Parts& parts, const PanelStageSettings& settings)
    : parts_(parts), settings_(settings) {
  screen_state_.eye = settings.eye;
  screen_state_.status.simulated = settings.simulated;
  screen_state_.status.software_rendering = settings.software_rendering;
  screen_state_.status.painting_blocked = !settings.painting_blocked.empty();
}

StepReport PanelStage::step(Instant now) noexcept {
  take_flips(now);
  auto target = parts_.panel.acquire();
  if (!target) {
    fault_.set(target.error());
    return {};
  }
  fill_status();
  if (!parts_.screen.draw(screen_state_, parts_.painter, *target)) {
    fault_.set(PortFault::unsupported);
    return {};
  }
  const auto serial = parts_.panel.present(parts_.clock.now());
  fault_.set(serial || serial.error() == PortFault::busy ? PortFault::nothing_yet : serial.error());
  if (!serial) return {};

  const PaintState& paint = parts_.painter_stage.state();
  Submitted& submitted = submitted_[*serial % submitted_.size()];
  submitted = {.serial = *serial,
               .frame = paint.newest,
               .has_new_frame = paint.newest_is_new,
               .captures_shown = parts_.captures.size(),
               .acknowledged_unit = paint.acknowledged_unit,
               .acknowledges = paint.acknowledged_unit != 0};
  submitted.frame.submitted_at = parts_.clock.now();
  parts_.painter_stage.mark_submitted();
  ++presented_;
  ++since_counted_;
  if (now >= count_due_) {
    screen_state_.status.rendered_hz =
        static_cast<float>(static_cast<double>(since_counted_) / seconds(1s + (now - count_due_)));
    since_counted_ = 0;
    count_due_ = now + 1s;
  }
  return {.worked = true, .items = 1};
}

void PanelStage::take_flips(Instant now) noexcept {
  for (std::size_t i = 0; i < submitted_.size(); ++i) {  // bound: no more pictures can be under way
    const std::optional<Flip> flip = parts_.panel.take_flip(now);
    if (!flip) return;
    const Submitted& shown = submitted_[flip->serial % submitted_.size()];
    if (shown.serial == flip->serial) settle(shown, flip->at);
  }
}

// Late is counted from the submit deadline: a frame is late when the picture that holds it was scanned out
// after the first vblank that follows its deadline.
void PanelStage::settle(const Submitted& shown, Instant scan_out) noexcept {
  if (shown.has_new_frame) {
    FrameRecord record = shown.frame;
    record.scan_out_at = scan_out;
    const Instant deadline = record.dequeued_at + settings_.submit_deadline;
    record.late = scan_out > parts_.panel.next_vblank(deadline);
    parts_.frames.append(record);
    longest_latency_ = std::max(longest_latency_, scan_out - record.dequeued_at);
    screen_state_.status.late_frames += record.late;
  }
  if (shown.acknowledges && shown.acknowledged_unit != last_acknowledged_) {
    last_acknowledged_ = shown.acknowledged_unit;
    acknowledged_scan_out_ = scan_out;
  }
  for (; settled_captures_ < shown.captures_shown;
       ++settled_captures_) {  // bound: captures since the last flip
    CaptureRecord& capture = parts_.captures.at(settled_captures_);
    capture.on_panel_at = scan_out;
    if (capture.unit == last_acknowledged_) capture.acknowledged_at = acknowledged_scan_out_;
  }
}

// The clock is read after the news: what came since the step began is not from ahead of it.
void PanelStage::fill_status() noexcept {
  (void)parts_.lanes.tracker_news.take(tracker_);
  (void)parts_.lanes.camera_news.take(camera_);
  (void)parts_.lanes.scope_now.take(scope_);
  (void)parts_.lanes.pedal_news.take(pedal_);
  const Instant now = parts_.clock.now();
  const PaintState& paint = parts_.painter_stage.state();
  Status& status = screen_state_.status;

  const FreshnessRules& rules = settings_.freshness;
  // The camera is judged by the newest that it sent, the inset by how far it lies behind that.
  // Where its stamps are wrong, both by when frames came: wrong stamps are no pulled cable.
  const Instant shown = camera_.stamps_wrong ? paint.newest.dequeued_at : paint.newest_exposed;
  const Instant sent = std::max(camera_.stamps_wrong ? camera_.last_dequeued : camera_.last_frame, shown);
  const Liveness video = std::min(rules.video(now, sent), rules.video(sent, shown));
  status.video = shown_as(camera_.connected ? video : Liveness::lost);
  status.tracker = shown_as(rules.tracker(now, tracker_.last_reply));
  const bool tracked = rules.tool_seen(now, tracker_.last_complete);
  status.tool_seen = tracked || tracker_.scope == ToolState::seen;
  status.reference_seen = tracked || tracker_.reference == ToolState::seen;
  status.degraded = degraded_.load(std::memory_order_relaxed);
  status.capture_acknowledged = paint.acknowledge_pending;
  status.streaming = paint.streaming;
  status.captures = paint.captures;

  screen_state_.show_live = status.video != Freshness::lost;
  screen_state_.scope_predicted = scope_.pose.kind == PoseKind::predicted;
  const bool show_scope = tracked && scope_.pose.kind != PoseKind::none && now - scope_.at < kScopeShownFor;
  if (scope_.turn_lack == TurnLack::none) screen_state_.turn_rad = scope_.turn_rad;
  screen_state_.X_MC = show_scope ? std::optional(scope_.X_MC) : std::nullopt;

  const bool stands = paint.version == screen_state_.paint_version;
  if (!stands && counted_version_ == screen_state_.paint_version) coverage_due_ = now + kFiguresEvery;
  screen_state_.paint_version = paint.version;
  if (counted_version_ != paint.version && (stands || now >= coverage_due_)) {
    coverage_.store(parts_.painter.coverage(), std::memory_order_relaxed);
    status.coverage = static_cast<float>(coverage());
    counted_version_ = paint.version;
  }
  if (now >= latency_due_ && longest_latency_ > Nanos{0}) {
    status.latency_ms = static_cast<float>(milliseconds(std::exchange(longest_latency_, Nanos{0})));
    latency_due_ = now + kFiguresEvery;
  }
  tell_misses();
  choose_notice(now);
}

// All steps over their bounds so far, and the stage of the newest.
void PanelStage::tell_misses() noexcept {
  Status& status = screen_state_.status;
  std::uint64_t misses = 0;
  Instant newest = Instant::min();
  for (const StageLedger& stage : parts_.stages) {  // bound: the topology's stages
    misses += stage.over_bound();
    const auto last = stage.last_miss();
    if (!last || *last < newest) continue;
    newest = *last;
    status.missed_stage = stage.name();
  }
  status.budget_misses = static_cast<std::uint32_t>(misses);
}

void PanelStage::choose_notice(Instant now) noexcept {
  const PaintState& paint = parts_.painter_stage.state();
  const Status& status = screen_state_.status;
  const bool loses = loses_captures(now);
  screen_state_.status.notice.level = Notice::Level::none;
  if (status.video == Freshness::lost)
    return notice(Notice::Level::alarm, "NO LIVE VIDEO: check the camera's cable");
  if (status.tracker == Freshness::lost)
    return notice(Notice::Level::alarm,
                  tracker_.refuses ? "TRACKER REFUSES: see the log" : "TRACKER LOST: check its cable");
  if (status.painting_blocked) return notice(Notice::Level::warning, settings_.painting_blocked);
  if (camera_.stamps_wrong) return notice(Notice::Level::warning, "CAMERA STAMPS WRONG: see [camera] stamp");
  if (tracker_.infrared)
    return notice(Notice::Level::warning, "TOO MUCH INFRA-RED LIGHT: shade or move the lamp");
  if (!status.tool_seen) return notice(Notice::Level::warning, "TOOL NOT SEEN: clear its line of sight");
  if (!status.reference_seen)
    return notice(Notice::Level::warning, "REFERENCE NOT SEEN: clear its line of sight");
  if (scope_.turn_lack != TurnLack::none && now - scope_.at < kScopeShownFor) return notice_turn();
  if (tracker_.bumped_at != Instant{} && now - tracker_.bumped_at < kBumpShownFor)
    return notice(Notice::Level::warning, "TRACKER BUMPED: verify on a landmark");
  if (camera_.frozen) return notice(Notice::Level::warning, "VIDEO FROZEN? The picture repeats");
  if (paint.failed_at != Instant{} && now - paint.failed_at < kNoticeTime)
    return notice(Notice::Level::warning, words_for(paint.last_refusal));
  if (loses) return notice(Notice::Level::warning, "SESSION NOT KEPT: the disk is full or too slow");
  if (!pedal_.connected) return notice(Notice::Level::warning, "PEDAL NOT CONNECTED: check its cable");
  if (paint.warned_at != Instant{} && now - paint.warned_at < kNoticeTime)
    return notice(Notice::Level::warning, "PEDAL: stuck; let it go");
  if (paint.undone_at != Instant{} && now - paint.undone_at < kNoticeTime)
    return notice(Notice::Level::info, "Taken back");
}

// As long as writes fail, and a while after each loss: a slow disk loses one capture here and there.
bool PanelStage::loses_captures(Instant now) noexcept {
  if (parts_.sink == nullptr) return false;
  if (const std::uint64_t lost = parts_.sink->lost(); lost != captures_lost_) {
    captures_lost_ = lost;
    lost_at_ = now;
  }
  return parts_.sink->failing() || (lost_at_ && now - *lost_at_ < kLossShownFor);
}

void PanelStage::notice_turn() noexcept {
  if (scope_.turn_lack != TurnLack::mismatch)
    return notice(Notice::Level::warning, words_for(scope_.turn_lack));
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "TURN MISMATCH: %s %d deg off the notch",
                suspect_for(settings_.turn), std::abs(scope_.mismatch_deg));
  notice(Notice::Level::warning, text.data());
}

void PanelStage::notice(Notice::Level level, std::string_view text) noexcept {
  Notice& notice = screen_state_.status.notice;
  notice.level = level;
  const std::size_t length = std::min(text.size(), notice.text.size() - 1);
  std::memcpy(notice.text.data(), text.data(), length);
  notice.text[length] = '\0';
}

}  // namespace orcart
