// The driver's state machine: starting, polling, waiting before the next try.
#include "firmware-host/tracker/ndi_driver.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/port_reply.hpp"
#include "firmware-host/tracker/ndi/words.hpp"

namespace orcart {
namespace {

constexpr std::uint16_t kPollOptions = ndi::kTransforms | ndi::kOutOfVolumeToo;
constexpr Nanos kFirstBackOff = 20ms;
constexpr Nanos kLongestBackOff = 2s;
constexpr Nanos kHostMargin = 8ms;
/// Actions of the start that one step may carry out; more than any stretch without waiting has.
constexpr int kActionsPerStep = 8;
constexpr double kUnitTolerance = 0.02;
constexpr std::uint8_t kInvalidCommand = 0x01;
constexpr std::uint8_t kWrongParameters = 0x07;
/// So often in a row no line damages a command by chance.
constexpr int kRefusalsBelieved = 3;

/// What a device answers to a command that was damaged on its way: unknown, too long, too short, a wrong CRC,
/// or a wrong number of parameters.
constexpr bool may_be_damage(std::uint8_t code) noexcept {
  return (code >= kInvalidCommand && code <= 0x04) || code == kWrongParameters;
}

Nanos patience_for(const NdiSettings& settings) noexcept {
  const Nanos wire = ndi::wire_time(poll_exchange_bytes(settings.tools.size(), settings.poll), settings.baud);
  return std::max(2 * period_of(settings.poll_rate_hz), wire + kHostMargin);
}

}  // namespace

NdiDriver::NdiDriver(NdiSettings settings, ByteLink& link)
    : settings_(std::move(settings)),
      link_(link),
      exchange_(link),
      start_(settings_),
      watch_(settings_.poll_rate_hz, settings_.device_rate_hz),
      period_(period_of(settings_.poll_rate_hz)),
      poll_patience_(patience_for(settings_)),
      back_off_(kFirstBackOff) {
  reply_.tool_count = static_cast<int>(settings_.tools.size());
}

DriverReport NdiDriver::step(Instant now) noexcept {
  DriverReport report;
  if (std::exchange(opened_in_vain_, false)) retry_at_ = now + pause_;
  if (phase_ == Phase::waiting && now >= retry_at_) retry(now);
  const ExchangeEvent event = link_is_down_ ? ExchangeEvent::none : exchange_.step(now);
  report.worked = event != ExchangeEvent::none;
  if (event == ExchangeEvent::link_down) {
    link_is_down_ = true;
    give_up(TrackerTrouble::disconnected, now);
  } else if (phase_ == Phase::starting) {
    advance_start(event, now);
  } else if (phase_ == Phase::polling) {
    advance_polling(event, now, report);
  }
  plan(now);
  report.health = health_;
  report.trouble = trouble_;
  return report;
}

void NdiDriver::retry(Instant now) noexcept {
  if (link_is_down_) {
    if (!link_.reopen()) {
      give_up(TrackerTrouble::disconnected, now);
      opened_in_vain_ = true;
      return;
    }
    link_is_down_ = false;
  }
  start(now);
}

void NdiDriver::start(Instant now) noexcept {
  if (std::exchange(started_before_, true)) ++counters_.restarts;
  exchange_.abandon();
  in_pause_ = false;
  start_.begin();
  phase_ = Phase::starting;
  advance_start(ExchangeEvent::none, now);
}

void NdiDriver::give_up(TrackerTrouble trouble, Instant now) noexcept {
  trouble_ = trouble;
  if (health_ != TrackerHealth::starting) health_ = TrackerHealth::lost;
  exchange_.abandon();
  phase_ = Phase::waiting;
  pause_ = back_off_;
  retry_at_ = now + pause_;
  back_off_ = std::min(2 * back_off_, kLongestBackOff);
}

bool NdiDriver::perform(const StartAction& action, Instant now) noexcept {
  using Kind = StartAction::Kind;
  switch (action.kind) {
    case Kind::send: {
      const bool sent = exchange_.begin(action.command, now, action.time);
      link_is_down_ = !sent;
      return sent;
    }
    case Kind::set_line: {
      const auto set = link_.set_line({.baud = action.baud, .flow = settings_.flow});
      if (set) {
        start_.on_done();
      } else {
        start_.on_line_refused();
      }
      return true;
    }
    case Kind::send_break:
      // A link that can send no break may have reset the device by other means, or not: RESET is awaited all
      // the same.
      (void)link_.send_break();
      start_.on_done();
      return true;
    case Kind::await_reset:
      exchange_.await_text(now, action.time);
      return true;
    case Kind::pause:
      in_pause_ = true;
      pause_until_ = now + action.time;
      return true;
    case Kind::finished:
    case Kind::failed:
      break;
  }
  return true;
}

void NdiDriver::advance_start(ExchangeEvent event, Instant now) noexcept {
  if (event == ExchangeEvent::reply) start_.on_reply(exchange_.frame().text());
  if (event == ExchangeEvent::damaged || event == ExchangeEvent::timed_out) start_.on_no_reply();
  if (in_pause_ && now >= pause_until_) {
    in_pause_ = false;
    start_.on_done();
  }
  for (int i = 0; i < kActionsPerStep && !exchange_.busy() && !in_pause_; ++i) {
    const StartAction action = start_.action();
    if (action.kind == StartAction::Kind::finished) return begin_polling(now);
    if (action.kind == StartAction::Kind::failed) {
      refused_with_ = start_.error_code();
      failed_tool_ = start_.failed_tool();
      return give_up(start_.trouble(), now);
    }
    if (!perform(action, now)) return give_up(TrackerTrouble::disconnected, now);
  }
}

/// BX2's replies are longer: on a slow line they may not fit where BX's do.
PollForm NdiDriver::best_form() const noexcept {
  PollLoad load = load_of(settings_);
  load.form = PollForm::bx2;
  const bool fits = rate_fits(load, settings_.baud == 0 ? 0 : start_.baud());
  return start_.knows_frames() && fits ? PollForm::bx2 : PollForm::bx;
}

void NdiDriver::begin_polling(Instant now) noexcept {
  phase_ = Phase::polling;
  ask_for_ports_ = ask_for_alerts_ = false;
  alerts_ = told_ = {};
  refusals_in_a_row_ = 0;
  failed_tool_ = -1;
  counter_hz_ = start_.counts_at_60_hz() ? 60 : settings_.device_rate_hz;
  form_ = settings_.poll;
  if (form_ == PollForm::automatic) form_ = best_form();
  port_status_.fill(ndi::kPortReady);
  watch_.begin(now);
  next_poll_ = now;
  ask(now);
}

/// A question about the device takes the place of one poll, so that there is never more than one command out.
ndi::Command NdiDriver::next_command() noexcept {
  if (std::exchange(ask_for_ports_, false)) {
    asked_ = Asked::ports;
    return ndi::search_ports(ndi::PortSearch::all);
  }
  if (std::exchange(ask_for_alerts_, false)) {
    asked_ = Asked::alerts;
    return ndi::get_parameter("Info.Status.New Alerts");
  }
  // No partner: the number alone is handed over.
  if (const int beeps = beeps_wanted_.exchange(0, std::memory_order_relaxed); beeps > 0) {
    asked_ = Asked::beep;
    return ndi::beep(beeps);
  }
  asked_ = Asked::poses;
  if (form_ == PollForm::tx) return ndi::poll_text(kPollOptions);
  return form_ == PollForm::bx2 ? ndi::poll_frames() : ndi::poll_binary(kPollOptions);
}

void NdiDriver::ask(Instant now) noexcept {
  link_is_down_ = !exchange_.begin(next_command(), now, poll_patience_);
  if (link_is_down_) {
    return give_up(TrackerTrouble::disconnected, now);
  }
  ++counters_.polls;
  // Slots that have passed are skipped; the phase is kept.
  const std::int64_t passed = (now - next_poll_) / period_;
  counters_.skipped_polls += static_cast<std::uint64_t>(passed);
  next_poll_ += (passed + 1) * period_;
}

void NdiDriver::advance_polling(ExchangeEvent event, Instant now, DriverReport& report) noexcept {
  if (event == ExchangeEvent::reply) take_reply(now, report);
  if (event == ExchangeEvent::damaged) {
    ++counters_.crc_bad;
    ++counters_.resyncs;
    watch_.on_damaged_reply(now);
  }
  if (event == ExchangeEvent::timed_out) ++counters_.timeouts;
  if (phase_ == Phase::polling) watch(now);
  if (phase_ == Phase::polling && !exchange_.busy() && now >= next_poll_) {
    ask(now);
    report.worked = true;
  }
}

void NdiDriver::watch(Instant now) noexcept {
  if (watch_.silent(now)) return give_up(TrackerTrouble::silent, now);
  if (watch_.frame_stuck()) return give_up(TrackerTrouble::frame_stuck, now);
  if (health_ == TrackerHealth::live && watch_.suspect(now)) health_ = TrackerHealth::suspect;
  if (watch_.suspect(now)) return;
  trouble_ = watch_.line_is_bad(now) ? TrackerTrouble::bad_crc : TrackerTrouble::none;
}

void NdiDriver::take_reply(Instant now, DriverReport& report) noexcept {
  const ndi::ReplyFrame& frame = exchange_.frame();
  if (exchange_.skipped() > 0) ++counters_.resyncs;
  const bool text_is_poses = asked_ == Asked::poses && form_ == PollForm::tx;
  if (frame.kind == ndi::ReplyKind::binary) return take_poses(now, report);
  if (!text_is_poses || ndi::error_code(frame.text()) || frame.text() == "RESET")
    return take_text(frame.text(), now);
  take_poses(now, report);
}

Result<ndi::TrackingReply, ndi::ReplyFault> NdiDriver::parsed() const noexcept {
  const ndi::ReplyFrame& frame = exchange_.frame();
  if (form_ == PollForm::tx) return ndi::parse_tx(frame.text(), kPollOptions);
  return form_ == PollForm::bx2 ? ndi::parse_bx2(frame.payload) : ndi::parse_bx(frame.payload, kPollOptions);
}

void NdiDriver::take_poses(Instant now, DriverReport& report) noexcept {
  const auto said = parsed();
  if (!said) {
    ++counters_.crc_bad;
    return watch_.on_damaged_reply(now);
  }
  ++counters_.replies;
  refusals_in_a_row_ = 0;
  watch_.on_good_reply(now);
  notice(*said);
  take_readings(*said, now, report);
}

void NdiDriver::notice(const ndi::TrackingReply& said) noexcept {
  if (said.has_frame) {
    // BX2 repeats an alert while it stands; it counts when it begins.
    alerts_.add(said.alerts.except(told_));
    told_ = said.alerts;
  }
  if ((said.system_status & ndi::kAlertsPending) != 0) ask_for_alerts_ = true;
}

void NdiDriver::take_text(std::string_view text, Instant now) noexcept {
  if (const auto code = ndi::error_code(text)) return take_refusal(*code, now);
  if (asked_ != Asked::poses && text != "RESET") return take_answer(text, now);
  // RESET, or an answer to nothing: the device has forgotten what it was told.
  give_up(TrackerTrouble::device_reset, now);
}

void NdiDriver::take_refusal(std::uint8_t code, Instant now) noexcept {
  if (asked_ == Asked::alerts || asked_ == Asked::beep)
    return watch_.on_good_reply(now);  // it cannot; no matter
  if (may_be_damage(code) && ++refusals_in_a_row_ < kRefusalsBelieved) {
    ++counters_.crc_bad;
    ask_for_ports_ = ask_for_ports_ || asked_ == Asked::ports;
    return watch_.on_damaged_reply(now);
  }
  refused_with_ = code;
  if (asked_ == Asked::poses && code == kInvalidCommand && settings_.poll == PollForm::automatic &&
      form_ != PollForm::tx) {
    form_ = form_ == PollForm::bx2 ? PollForm::bx : PollForm::tx;
    refusals_in_a_row_ = 0;
    return watch_.on_good_reply(now);  // it answers; the next form has its own time
  }
  // Else it is not tracking, or not initialised: the device has forgotten what it was told.
  give_up(may_be_damage(code) ? TrackerTrouble::device_refuses : TrackerTrouble::device_reset, now);
}

void NdiDriver::take_answer(std::string_view text, Instant now) noexcept {
  watch_.on_good_reply(now);
  if (asked_ == Asked::ports) return take_port_list(text);
  if (asked_ != Asked::alerts) return;
  const std::string_view digits = text.substr(std::min(text.find('=') + 1, text.size()));
  std::uint32_t bits = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits);
  if (error == std::errc{} && end != digits.data()) alerts_.add(ndi::alerts_from_parameter(bits));
}

int NdiDriver::tool_of(std::uint8_t handle) const noexcept {
  for (int tool = 0; tool < reply_.tool_count; ++tool) {
    if (start_.handle_of(tool) == handle) return tool;
  }
  return -1;
}

ToolReading NdiDriver::judged(const ndi::HandleReading& said) const noexcept {
  ToolReading tool{.error_mm = said.error_mm, .port_status = said.port_status, .device_frame = said.frame};
  if (said.status == ndi::HandleStatus::disabled) tool.state = ToolState::disabled;
  if (!said.has_transform) return tool;
  tool.quaternion =
      Eigen::Quaterniond(said.quaternion[0], said.quaternion[1], said.quaternion[2], said.quaternion[3]);
  tool.translation_mm = Eigen::Vector3f(said.translation_mm.data()).cast<double>();
  const bool is_pose = std::abs(tool.quaternion.norm() - 1.0) < kUnitTolerance &&
                       tool.translation_mm.allFinite() && std::isfinite(said.error_mm);
  const bool ready = (tool.port_status & ndi::kPortReady) == ndi::kPortReady;
  const bool inside = (tool.port_status & (ndi::kOutOfVolume | ndi::kPartlyInVolume)) == 0;
  const bool fits =
      settings_.max_error_mm <= 0 || static_cast<double>(said.error_mm) <= settings_.max_error_mm;
  tool.state = is_pose && ready && inside && fits ? ToolState::seen : ToolState::doubtful;
  if (is_pose) {
    tool.quaternion.normalize();
  } else {
    tool.quaternion.setIdentity();
    tool.translation_mm.setZero();
  }
  return tool;
}

void NdiDriver::take_readings(const ndi::TrackingReply& said, Instant now, DriverReport& report) noexcept {
  TrackerReply reply{.arrived_at = exchange_.arrived_at(),
                     .asked_at = exchange_.asked_at(),
                     .wire_time = ndi::wire_time(exchange_.frame().consumed - exchange_.frame().skipped,
                                                 settings_.baud == 0 ? 0 : start_.baud()),
                     .tool_count = reply_.tool_count,
                     .system_status = said.system_status};
  bool any_frame = false;
  for (const ndi::HandleReading& reading : said.readings()) {
    const int tool = tool_of(reading.handle);
    if (tool < 0) {
      ++counters_.unknown_handles;
      continue;
    }
    const auto index = static_cast<std::size_t>(tool);
    reply.tools[index] = judged(reading);
    if (reading.status == ndi::HandleStatus::disabled) {
      ask_for_ports_ = ask_for_ports_ || reply_.tools[index].state != ToolState::disabled;
      reply.tools[index].port_status = port_status_[index];
    } else {
      any_frame = true;
      reply.device_frame = std::max(reply.device_frame, reading.frame);
    }
  }
  // Where no tool has a frame number (all disabled, or none of the handles is ours) the device measures
  // nothing.
  if (!any_frame) reply.device_frame = reply_.device_frame;
  const bool fresh = watch_.on_frame(reply.device_frame, now) || (!any_frame && said.has_frame);
  health_ = TrackerHealth::live;
  back_off_ = kFirstBackOff;
  if (!fresh) {
    ++counters_.repeats;
    return;
  }
  for (std::size_t i = 0; i < settings_.tools.size(); ++i) {
    if (reply.tools[i].state == ToolState::unseen) ++counters_.missing[i];
    if (reply.tools[i].state == ToolState::disabled) ++counters_.disabled[i];
  }
  reply_ = reply;
  report.new_reply = true;
}

void NdiDriver::take_port_list(std::string_view text) noexcept {
  const auto listed = ndi::parse_port_handles(text);
  if (!listed) return;
  port_status_.fill(0);
  for (const ndi::PortHandle& port : listed->all()) {
    const int tool = tool_of(port.handle);
    if (tool >= 0) port_status_[static_cast<std::size_t>(tool)] = port.status;
  }
}

std::string_view NdiDriver::disabled_reason(int tool) const noexcept {
  return ndi::disabled_reason(port_status_[static_cast<std::size_t>(tool)]);
}

void NdiDriver::plan(Instant now) noexcept {
  if (phase_ == Phase::waiting) {
    next_due_ = opened_in_vain_ ? now : retry_at_;
  } else if (phase_ == Phase::starting) {
    next_due_ = in_pause_ ? pause_until_ : exchange_.deadline();
  } else {
    const Instant next_work = exchange_.busy() ? exchange_.deadline() : next_poll_;
    next_due_ = std::min(next_work, watch_.next_verdict(now));
  }
}

TrackerState NdiDriver::state() const noexcept {
  constexpr double kSlower = 0.8;
  TrackerState state{.trouble = trouble_};
  if (refuses(trouble_)) {
    state.error_code = refused_with_;
    state.tool = static_cast<std::int8_t>(failed_tool_);
  }
  if (health_ != TrackerHealth::live) return state;
  for (int tool = reply_.tool_count - 1; tool >= 0; --tool) {
    const auto index = static_cast<std::size_t>(tool);
    // The reason is asked for: until it has come the port still counts as ready.
    const bool told = (port_status_[index] & ndi::kPortReady) != ndi::kPortReady;
    if (reply_.tools[index].state != ToolState::disabled || !told) continue;
    state.disabled_tool = static_cast<std::int8_t>(tool);
    state.port_status = port_status_[index];
  }
  const double rate_hz = watch_.frame_rate_hz();
  if (rate_hz > 0 && rate_hz < kSlower * settings_.device_rate_hz)
    state.slow_hz = static_cast<std::uint16_t>(std::lround(rate_hz));
  return state;
}

std::string NdiDriver::trouble_sentence(const TrackerState& state) const {
  std::string sentence(word_for(state.trouble));
  if (state.tool >= 0)
    sentence += " for tool " + settings_.tools[static_cast<std::size_t>(state.tool)].name();
  if (state.error_code != 0) sentence += ": " + std::string(ndi::error_word(state.error_code));
  return sentence;
}

std::string NdiDriver::remark(const TrackerState& state) const {
  if (state.disabled_tool >= 0) {
    return "tool " + settings_.tools[static_cast<std::size_t>(state.disabled_tool)].name() +
           " is not tracked: " + std::string(ndi::disabled_reason(state.port_status));
  }
  if (state.slow_hz == 0) return {};
  return "the device measures at " + std::to_string(state.slow_hz) + " Hz, not at the " +
         std::to_string(std::lround(settings_.device_rate_hz)) + " Hz of rate_hz; write what it does";
}

}  // namespace orcart
