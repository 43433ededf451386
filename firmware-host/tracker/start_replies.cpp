// What the start makes of each reply.
#include <algorithm>

#include "firmware-host/tracker/ndi/words.hpp"
#include "firmware-host/tracker/start_sequence.hpp"

namespace orcart {
namespace {

constexpr std::size_t kBlocks = ndi::kRomMemoryBytes / ndi::kRomBlockBytes;
constexpr int kWiredRounds = 3;

/// The fastest rate below `baud` over which the polls still fit; 0 where none does.
std::uint32_t slower_that_fits(const NdiSettings& settings, std::uint32_t baud) noexcept {
  const auto slower = ndi::next_slower(baud);
  return slower && rate_fits(load_of(settings), *slower) ? *slower : 0;
}

/// What follows `mark` on its line; the whole first line where it is not there.
std::string_view behind(std::string_view text, std::string_view mark) noexcept {
  const std::size_t at = text.find(mark);
  if (at != std::string_view::npos) text.remove_prefix(at + mark.size());
  return text.substr(0, text.find('\n'));
}

}  // namespace

void StartSequence::after_init() noexcept {
  const bool change = settings_.baud != 0 && wanted_baud_ != line_baud_;
  go(change ? Step::comm : Step::api_revision);
}

void StartSequence::on_done() noexcept {
  switch (step_) {
    case Step::fast_line:
      go(Step::fast_probe);
      break;
    case Step::slow_line:
      line_baud_ = ndi::kPowerOnBaud;
      go(Step::slow_probe);
      break;
    case Step::send_break:
      go(Step::await_reset);
      break;
    case Step::settle_after_reset:
      go(Step::probe_after_reset);
      break;
    case Step::settle_after_init:
      after_init();
      break;
    case Step::settle_after_comm:
      go(Step::comm_line);
      break;
    case Step::comm_line:
      line_baud_ = wanted_baud_;
      go(Step::api_revision);
      break;
    default:
      break;
  }
}

void StartSequence::on_line_refused() noexcept {
  if (step_ == Step::comm_line)
    wanted_baud_ = std::max(slower_that_fits(settings_, wanted_baud_), line_baud_);
  fail(TrackerTrouble::not_answering);
}

void StartSequence::on_no_reply() noexcept {
  switch (step_) {
    case Step::fast_probe:
      if (settings_.baud != 0) return go(Step::slow_line);
      break;
    case Step::slow_probe:
      return go(Step::send_break);
    case Step::api_revision: {
      // Nothing at the new rate: the two sides did not meet there, so a slower one is tried after the next
      // probe.
      const std::uint32_t slower = slower_that_fits(settings_, wanted_baud_);
      wanted_baud_ = slower != 0 ? slower : settings_.baud;
      line_baud_ = ndi::kPowerOnBaud;
      break;
    }
    default:
      break;
  }
  fail(TrackerTrouble::not_answering);
}

void StartSequence::on_error(std::uint8_t code) noexcept {
  switch (step_) {
    case Step::free_old:
      return next_old_handle();  // a wired tool's handle stays
    case Step::api_revision:
      return go(Step::firmware);
    case Step::firmware:
      return go(Step::version);
    case Step::version:
      return go(Step::rate);
    case Step::rate:
      return go(knows_frames() ? Step::share : Step::list_old);  // a device of one rate
    case Step::share:
      return go(Step::list_old);  // a device that reports every frame
    case Step::initialise_wired:
      return next_wired(Step::initialise_wired, Step::list_new_again);  // another port's tool may be broken
    case Step::locate:
      return next_wired(Step::locate, Step::describe);
    case Step::beep:
      return go(Step::finished);
    default:
      break;
  }
  const std::uint32_t slower = slower_that_fits(settings_, wanted_baud_);
  if (step_ == Step::comm && slower != 0) {
    wanted_baud_ = slower;
    return after_init();
  }
  fail(TrackerTrouble::device_refuses, code);
}

void StartSequence::next_tool(Step again, Step then) noexcept {
  if (++tool_ < settings_.tools.size()) return go(again);
  tool_ = 0;
  go(then);
}

void StartSequence::next_wireless(Step again, Step then) noexcept {
  block_ = 0;
  do {
    ++tool_;
  } while (tool_ < settings_.tools.size() && settings_.tools[tool_].wired);
  if (tool_ < settings_.tools.size()) return go(again);
  tool_ = 0;
  go(then);
}

void StartSequence::first_wireless(Step step, Step then) noexcept {
  tool_ = 0;
  if (!settings_.tools[0].wired) return go(step);
  next_wireless(step, then);
}

void StartSequence::next_wired(Step again, Step then) noexcept {
  if (++wired_next_ < wired_count_) return go(again);
  wired_next_ = 0;
  if (then == Step::describe) return all_located();
  go(then);
}

void StartSequence::after_wireless() noexcept {
  wired_next_ = 0;
  go(wired_count_ > 0 ? Step::initialise_wired : Step::list_initialised);
}

void StartSequence::next_old_handle() noexcept {
  if (++old_next_ >= old_count_) first_wireless(Step::request, Step::list_new);
}

void StartSequence::next_block() noexcept {
  if (++block_ == kBlocks) next_wireless(Step::request, Step::list_new);
}

void StartSequence::on_okay() noexcept {
  switch (step_) {
    case Step::fast_probe:
    case Step::slow_probe:
    case Step::probe_after_reset:
      return go(Step::settle_after_init);
    case Step::comm:
      return go(Step::settle_after_comm);
    case Step::free_old:
      return next_old_handle();
    case Step::upload:
      return next_block();
    case Step::initialise:
      next_wireless(Step::initialise, Step::list_initialised);
      if (step_ == Step::list_initialised) after_wireless();
      return;
    case Step::initialise_wired:
      return next_wired(Step::initialise_wired, Step::list_new_again);
    case Step::enable:
      return next_tool(Step::describe, Step::start);
    case Step::start:
      return go(settings_.beeps_when_tracking > 0 ? Step::beep : Step::finished);
    case Step::api_revision:
    case Step::firmware:
    case Step::version:
      return on_error(0);  // no answer to a question
    case Step::rate:
      return go(knows_frames() ? Step::share : Step::list_old);
    case Step::share:
      return go(Step::list_old);
    case Step::beep:
      return go(Step::finished);
    default:
      return fail(TrackerTrouble::bad_answer);
  }
}

bool StartSequence::lists_all_tools(std::string_view text) const noexcept {
  const auto listed = ndi::parse_port_handles(text);
  if (!listed) return false;
  const auto all = listed->all();
  for (std::size_t tool = 0; tool < settings_.tools.size(); ++tool) {
    if (settings_.tools[tool].wired) continue;
    const auto is_ours = [&](const ndi::PortHandle& port) { return port.handle == handles_[tool]; };
    if (std::none_of(all.begin(), all.end(), is_ours)) return false;
  }
  return true;
}

void StartSequence::keep_wired(const ndi::PortHandles& listed) noexcept {
  wired_count_ = wired_next_ = 0;
  if (!has_wired_) return;
  for (const ndi::PortHandle& port : listed.all()) {
    bool wireless = false;
    for (std::size_t tool = 0; tool < settings_.tools.size(); ++tool)
      wireless = wireless || (!settings_.tools[tool].wired && handles_[tool] == port.handle);
    if (!wireless && wired_count_ < wired_.size()) wired_[wired_count_++] = port.handle;
  }
}

void StartSequence::locate(std::string_view text) noexcept {
  const auto location = ndi::parse_port_location(text);
  for (std::size_t tool = 0; location && location->wired && tool < settings_.tools.size(); ++tool) {
    const auto& wanted = settings_.tools[tool].wired;
    if (wanted && wanted->number == location->port && wanted->channel == location->channel)
      handles_[tool] = wired_[wired_next_];
  }
  next_wired(Step::locate, Step::describe);
}

void StartSequence::all_located() noexcept {
  for (tool_ = 0; tool_ < settings_.tools.size(); ++tool_) {
    if (!settings_.tools[tool_].wired || handles_[tool_] != 0) continue;
    step_ = Step::describe;  // busy with this tool
    return fail(TrackerTrouble::tool_absent);
  }
  tool_ = 0;
  go(Step::describe);
}

void StartSequence::on_list(std::string_view text) noexcept {
  const auto listed = ndi::parse_port_handles(text);
  if (!listed) return fail(TrackerTrouble::bad_answer);
  const bool complete = lists_all_tools(text);
  switch (step_) {
    case Step::list_old:
      old_count_ = std::min(listed->count, old_.size());
      old_next_ = 0;
      for (std::size_t i = 0; i < old_count_; ++i) old_[i] = listed->list[i].handle;
      return old_count_ > 0 ? go(Step::free_old) : first_wireless(Step::request, Step::list_new);
    case Step::list_new:
      if (!complete) return fail(TrackerTrouble::bad_answer);
      keep_wired(*listed);
      first_wireless(Step::initialise, Step::list_initialised);
      return step_ == Step::list_initialised ? after_wireless() : void();
    case Step::list_new_again:
      keep_wired(*listed);
      return wired_count_ > 0 && ++wired_rounds_ < kWiredRounds ? go(Step::initialise_wired)
                                                                : go(Step::list_initialised);
    default:
      if (!complete) return fail(TrackerTrouble::bad_answer);
      keep_wired(*listed);
      return wired_count_ > 0 ? go(Step::locate) : all_located();
  }
}

void StartSequence::on_version(std::string_view text) noexcept {
  switch (step_) {
    case Step::api_revision:
      api_revision_.assign(text);
      return go(Step::firmware);
    case Step::firmware:
      firmware_.assign(behind(text, "="));
      return go(Step::rate);
    default:
      firmware_.assign(behind(text, "Freeze Tag: "));
      return go(Step::rate);
  }
}

void StartSequence::on_reply(std::string_view text) noexcept {
  if (const auto code = ndi::error_code(text)) return on_error(*code);
  if (text == "OKAY") return on_okay();
  // Done all the same: a Polaris so initialises a tool whose memory it finds odd, and tracks it.
  if (text.starts_with("WARNING")) return on_okay();
  switch (step_) {
    case Step::await_reset:
      return text == "RESET" ? go(Step::settle_after_reset) : on_no_reply();
    case Step::api_revision:
    case Step::firmware:
    case Step::version:
      return on_version(text);
    case Step::list_old:
    case Step::list_new:
    case Step::list_new_again:
    case Step::list_initialised:
      return on_list(text);
    case Step::locate:
      return locate(text);
    case Step::request: {
      const auto handle = ndi::parse_new_handle(text);
      if (!handle) return fail(TrackerTrouble::bad_answer);
      handles_[tool_] = *handle;
      return go(Step::upload);
    }
    case Step::describe: {
      const auto port = ndi::parse_port_description(text, ndi::kPortBasics | ndi::kPartNumber);
      return port && port->occupied ? go(Step::enable) : fail(TrackerTrouble::bad_answer);
    }
    case Step::beep:
      return go(Step::finished);  // 1 or 0: it beeps, or still does
    case Step::fast_probe:
    case Step::slow_probe:
      return on_no_reply();
    default:
      return fail(TrackerTrouble::bad_answer);
  }
}

}  // namespace orcart
