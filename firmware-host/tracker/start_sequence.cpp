// The start of an NDI device, command by command.
#include "firmware-host/tracker/start_sequence.hpp"

#include <algorithm>

#include "firmware-host/tracker/ndi/port_reply.hpp"
#include "firmware-host/tracker/ndi/words.hpp"

namespace orcart {
namespace {

constexpr Nanos kFastProbe = 300ms;  ///< a device that was just tracking answers at once
constexpr Nanos kSlowProbe = 1s;
constexpr Nanos kFirstInit = 5s;  ///< after power-on
constexpr Nanos kSettle = 100ms;  ///< NDI asks for it after INIT and COMM
constexpr Nanos kPatience = 2s;
constexpr std::size_t kBlocks = ndi::kRomMemoryBytes / ndi::kRomBlockBytes;

/// The fastest rate below `baud` over which the polls still fit; 0 where none does.
std::uint32_t slower_that_fits(const NdiSettings& settings, std::uint32_t baud) noexcept {
  const auto slower = ndi::next_slower(baud);
  const bool fits = slower && rate_fits(settings.tools.size(), settings.poll_rate_hz, *slower);
  return fits ? *slower : 0;
}

}  // namespace

StartSequence::StartSequence(const NdiSettings& settings) noexcept
    : settings_(settings), wanted_baud_(settings.baud) {}

void StartSequence::begin() noexcept {
  tool_ = block_ = old_count_ = old_next_ = 0;
  const bool network = settings_.baud == 0;
  go(network || line_baud_ != ndi::kPowerOnBaud ? Step::fast_line : Step::slow_line);
  if (network) go(Step::fast_probe);
}

bool StartSequence::busy_with_a_tool() const noexcept {
  return step_ == Step::request || step_ == Step::upload || step_ == Step::initialise ||
         step_ == Step::describe || step_ == Step::enable;
}

void StartSequence::fail(TrackerTrouble trouble, std::uint8_t error_code) noexcept {
  error_code_ = error_code;
  failed_tool_ = busy_with_a_tool() ? static_cast<int>(tool_) : -1;
  trouble_ = trouble;
  go(Step::failed);
}

StartAction StartSequence::send(const ndi::Command& command, Nanos patience) const noexcept {
  return {.kind = StartAction::Kind::send, .command = command, .time = patience};
}

StartAction StartSequence::tool_command() const noexcept {
  const std::uint8_t handle = handles_[tool_];
  const ndi::ToolDefinition& tool = settings_.tools[tool_];
  switch (step_) {
    case Step::request:
      return send(ndi::request_wireless_handle(), kPatience);
    case Step::upload: {
      const auto block =
          std::span{tool.memory}.subspan(block_ * ndi::kRomBlockBytes).first<ndi::kRomBlockBytes>();
      return send(ndi::write_rom(handle, block_, block), kPatience);
    }
    case Step::initialise:
      return send(ndi::initialise_port(handle), kPatience);
    case Step::describe:
      return send(ndi::describe_port(handle, ndi::kPortBasics | ndi::kPartNumber), kPatience);
    default:
      return send(ndi::enable_port(handle, tool.priority()), kPatience);
  }
}

StartAction StartSequence::action() const noexcept {
  using Kind = StartAction::Kind;
  switch (step_) {
    case Step::fast_line:
      return {.kind = Kind::set_line, .baud = line_baud_};
    case Step::fast_probe:
      return send(ndi::initialise(), settings_.baud == 0 ? kFirstInit : kFastProbe);
    case Step::slow_line:
      return {.kind = Kind::set_line, .baud = ndi::kPowerOnBaud};
    case Step::slow_probe:
      return send(ndi::initialise(), kSlowProbe);
    case Step::send_break:
      return {.kind = Kind::send_break};
    case Step::await_reset:
      return {.kind = Kind::await_reset, .time = settings_.reset_patience};
    case Step::probe_after_reset:
      return send(ndi::initialise(), kFirstInit);
    case Step::settle_after_reset:
    case Step::settle_after_init:
    case Step::settle_after_comm:
      return {.kind = Kind::pause, .time = kSettle};
    case Step::comm: {
      const char code = ndi::code_of_baud(wanted_baud_).value_or('0');
      return send(ndi::set_line(code, settings_.flow == FlowControl::hardware), kPatience);
    }
    case Step::comm_line:
      return {.kind = Kind::set_line, .baud = wanted_baud_};
    case Step::list_old:
      return send(ndi::search_ports(ndi::PortSearch::all), kPatience);
    case Step::free_old:
      return send(ndi::free_port(old_[old_next_]), kPatience);
    case Step::list_new:
      return send(ndi::search_ports(ndi::PortSearch::uninitialised), kPatience);
    case Step::list_initialised:
      return send(ndi::search_ports(ndi::PortSearch::not_enabled), kPatience);
    case Step::request:
    case Step::upload:
    case Step::initialise:
    case Step::describe:
    case Step::enable:
      return tool_command();
    case Step::start:
      return send(ndi::start_tracking(), kPatience);
    case Step::finished:
      return {.kind = Kind::finished};
    case Step::failed:
      break;
  }
  return {.kind = Kind::failed};
}

void StartSequence::after_init() noexcept {
  const bool change = settings_.baud != 0 && wanted_baud_ != line_baud_;
  go(change ? Step::comm : Step::list_old);
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
      go(Step::list_old);
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
    case Step::list_old: {
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
  if (step_ == Step::free_old) return next_old_handle();  // a wired tool's handle stays
  const std::uint32_t slower = slower_that_fits(settings_, wanted_baud_);
  if (step_ == Step::comm && slower != 0) {
    wanted_baud_ = slower;
    return after_init();
  }
  fail(TrackerTrouble::device_refuses, code);
}

void StartSequence::next_tool(Step again, Step then) noexcept {
  block_ = 0;
  if (++tool_ < settings_.tools.size()) return go(again);
  tool_ = 0;
  go(then);
}

void StartSequence::next_old_handle() noexcept {
  if (++old_next_ >= old_count_) go(Step::request);
}

void StartSequence::next_block() noexcept {
  if (++block_ == kBlocks) next_tool(Step::request, Step::list_new);
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
      return next_tool(Step::initialise, Step::list_initialised);
    case Step::enable:
      return next_tool(Step::describe, Step::start);
    case Step::start:
      return go(Step::finished);
    default:
      return fail(TrackerTrouble::bad_answer);
  }
}

bool StartSequence::lists_all_tools(std::string_view text) const noexcept {
  const auto listed = ndi::parse_port_handles(text);
  if (!listed) return false;
  const auto all = listed->all();
  const auto ours = std::span{handles_}.first(settings_.tools.size());
  return std::all_of(ours.begin(), ours.end(), [&](std::uint8_t handle) {
    return std::any_of(all.begin(), all.end(),
                       [&](const ndi::PortHandle& port) { return port.handle == handle; });
  });
}

void StartSequence::on_list(std::string_view text) noexcept {
  const auto listed = ndi::parse_port_handles(text);
  if (!listed) return fail(TrackerTrouble::bad_answer);
  old_count_ = std::min(listed->count, old_.size());
  old_next_ = 0;
  for (std::size_t i = 0; i < old_count_; ++i) old_[i] = listed->list[i].handle;
  go(old_count_ > 0 ? Step::free_old : Step::request);
}

void StartSequence::on_reply(std::string_view text) noexcept {
  if (const auto code = ndi::error_code(text)) return on_error(*code);
  if (text == "OKAY") return on_okay();
  switch (step_) {
    case Step::await_reset:
      return text == "RESET" ? go(Step::settle_after_reset) : on_no_reply();
    case Step::list_old:
      return on_list(text);
    case Step::request: {
      const auto handle = ndi::parse_new_handle(text);
      if (!handle) return fail(TrackerTrouble::bad_answer);
      handles_[tool_] = *handle;
      return go(Step::upload);
    }
    case Step::list_new:
      return lists_all_tools(text) ? go(Step::initialise) : fail(TrackerTrouble::bad_answer);
    case Step::list_initialised:
      return lists_all_tools(text) ? go(Step::describe) : fail(TrackerTrouble::bad_answer);
    case Step::describe: {
      const auto port = ndi::parse_port_description(text, ndi::kPortBasics | ndi::kPartNumber);
      return port && port->occupied ? go(Step::enable) : fail(TrackerTrouble::bad_answer);
    }
    case Step::fast_probe:
    case Step::slow_probe:
      return on_no_reply();
    default:
      return fail(TrackerTrouble::bad_answer);
  }
}

}  // namespace orcart
