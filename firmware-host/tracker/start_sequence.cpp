// The start of an NDI device, command by command.
#include "firmware-host/tracker/start_sequence.hpp"

#include <algorithm>

namespace orcart {
namespace {

constexpr Nanos kFastProbe = 300ms;  ///< a device that was just tracking answers at once
constexpr Nanos kSlowProbe = 1s;
constexpr Nanos kFirstInit = 5s;  ///< after power-on
constexpr Nanos kSettle = 100ms;  ///< NDI asks for it after INIT and COMM
constexpr Nanos kPatience = 2s;
constexpr std::uint32_t kEveryFrame = 2;  ///< of Track Frequency: 1/3, 1/2, 1/1 of the Frame Frequency
constexpr Nanos kWiredPatience = 6s;      ///< an Aurora reads a tool's memory for 2.6 s

}  // namespace

StartSequence::StartSequence(const NdiSettings& settings) noexcept
    : settings_(settings),
      wanted_baud_(settings.baud),
      line_baud_(settings.baud != 0 ? settings.baud : ndi::kPowerOnBaud),
      has_wired_(std::any_of(settings.tools.begin(), settings.tools.end(),
                             [](const TrackedTool& tool) { return tool.wired.has_value(); })) {}

void ShortText::assign(std::string_view text) noexcept {
  size_ = 0;
  for (const char letter : text) {
    if (letter >= ' ' && letter <= '~' && size_ < letters_.size()) letters_[size_++] = letter;
  }
}

bool StartSequence::knows_frames() const noexcept {
  const std::string_view revision = api_revision_.view();
  return revision.size() >= 5 && revision[0] == 'G' && revision.substr(2, 3) >= "003";
}

bool StartSequence::counts_at_60_hz() const noexcept {
  return !knows_frames() && (api_revision().starts_with("G") || firmware().starts_with("POLARIS"));
}

void StartSequence::begin() noexcept {
  tool_ = block_ = old_count_ = old_next_ = 0;
  wired_count_ = wired_next_ = 0;
  wired_rounds_ = 0;
  handles_.fill(0);
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
  const TrackedTool& tool = settings_.tools[tool_];
  switch (step_) {
    case Step::request:
      return send(ndi::request_wireless_handle(), kPatience);
    case Step::upload: {
      const auto block = std::span{tool.definition.memory}
                             .subspan(block_ * ndi::kRomBlockBytes)
                             .first<ndi::kRomBlockBytes>();
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

StartAction StartSequence::set_rate() const noexcept {
  const auto rate_hz = static_cast<std::uint32_t>(settings_.device_rate_hz + 0.5);
  if (knows_frames()) return send(ndi::set_parameter("Param.Tracking.Frame Frequency", rate_hz), kPatience);
  return send(ndi::set_illuminator_rate(rate_hz >= 60 ? 2 : rate_hz >= 30 ? 1 : 0), kPatience);
}

StartAction StartSequence::ask_or_tell() const noexcept {
  switch (step_) {
    case Step::api_revision:
      return send(ndi::ask_api_revision(), kPatience);
    case Step::firmware:
      return send(ndi::get_parameter("Features.Firmware.Version"), kPatience);
    case Step::version:
      return send(ndi::ask_version(), kPatience);
    case Step::rate:
      return set_rate();
    case Step::share:
      return send(ndi::set_parameter("Param.Tracking.Track Frequency", kEveryFrame), kPatience);
    default:
      return send(ndi::beep(settings_.beeps_when_tracking), kPatience);
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
      return send(ndi::search_ports(has_wired_ ? ndi::PortSearch::to_free : ndi::PortSearch::all), kPatience);
    case Step::free_old:
      return send(ndi::free_port(old_[old_next_]), kPatience);
    case Step::list_new:
    case Step::list_new_again:
      return send(ndi::search_ports(ndi::PortSearch::uninitialised), kPatience);
    case Step::list_initialised:
      return send(ndi::search_ports(ndi::PortSearch::not_enabled), kPatience);
    case Step::initialise_wired:
      return send(ndi::initialise_port(wired_[wired_next_]), kWiredPatience);
    case Step::locate:
      return send(ndi::describe_port(wired_[wired_next_], ndi::kPortLocation), kPatience);
    case Step::api_revision:
    case Step::firmware:
    case Step::version:
    case Step::rate:
    case Step::share:
    case Step::beep:
      return ask_or_tell();
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

}  // namespace orcart
