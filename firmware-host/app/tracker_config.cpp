// Reads [tracker], each kind with its own keys.
#include "firmware-host/app/tracker_config.hpp"

#include <array>
#include <string_view>

namespace orcart {
namespace {

void read_line(const TomlSection& section, TrackerConfig& tracker) {
  tracker.baud = static_cast<std::uint32_t>(
      section.integer("baud", {.min = 9600, .max = 1'228'739, .fallback = 115'200}));
  if (tracker.kind == TrackerKind::usb && tracker.baud == 19'200)
    section.refuse("baud", "stands for 1.2 Mbaud on NDI's USB converters; write 1228739, or 38400 and less");
  if (!ndi::code_of_baud(tracker.baud))
    section.refuse("baud",
                   "is none that NDI devices have; accepted are 9600, 14400, 19200, 38400, 57600, 115200, "
                   "230400, 921600, 1228739");
  tracker.flow = section.choice_of<FlowControl>(
      "flow", {{"none", FlowControl::none}, {"hardware", FlowControl::hardware}}, FlowControl::none);
}

void read_way(const TomlSection& section, TrackerConfig& tracker) {
  switch (tracker.kind) {
    case TrackerKind::simulated:
      break;
    case TrackerKind::usb:
      if (section.has("serial")) tracker.usb_serial = section.text("serial");
      if (section.has("port")) tracker.usb_port = section.text("port");
      break;
    case TrackerKind::tty:
      tracker.device = section.path("device");
      break;
    case TrackerKind::tcp:
      tracker.host = section.text("host");
      tracker.port =
          static_cast<std::uint16_t>(section.integer("port", {.min = 1, .max = 65'535, .fallback = 8765}));
      break;
    case TrackerKind::replay:
      tracker.dialogue = section.path("dialogue");
      break;
  }
}

/// A wireless tool by its definition, or a wired one by its port.
void read_tool(const TomlSection& section, const std::string& tool, std::filesystem::path& rom,
               TrackedTool::Port& port) {
  const std::string rom_key = tool + "_rom", port_key = tool + "_port";
  if (!section.has(port_key)) {
    rom = section.path(rom_key);
    return;
  }
  port.number = static_cast<int>(section.integer(port_key, {.min = 1, .max = 12}));
  port.channel = static_cast<int>(section.integer(tool + "_channel", {.min = 0, .max = 2, .fallback = 0}));
  if (section.has(rom_key)) {
    (void)section.path(rom_key);
    section.refuse(rom_key, "stands beside " + port_key + "; a tool is either wireless or plugged in");
  }
}

bool is_same(const TrackedTool& a, const TrackedTool& b) {
  if (a.wired.has_value() != b.wired.has_value()) return false;
  if (a.wired) return a.wired->number == b.wired->number && a.wired->channel == b.wired->channel;
  return a.definition.memory == b.definition.memory;
}

/// One tool under two names would be its own reference. Names are those of the keys.
Result<void> check_distinct(const std::vector<TrackedTool>& tools) {
  constexpr std::array<std::string_view, 3> kNames{"scope", "reference", "second"};
  for (std::size_t a = 0; a < tools.size(); ++a) {
    for (std::size_t b = a + 1; b < tools.size(); ++b) {
      if (!is_same(tools[a], tools[b])) continue;
      const std::string what = tools[a].wired ? "_port" : "_rom";
      return fail("[tracker] " + std::string(kNames[a]) + what + " and " + std::string(kNames[b]) + what +
                  " name the same tool (" + tools[a].name() + "); each wants one of its own");
    }
  }
  return {};
}

}  // namespace

void read_tracker(const TomlSection& section, TrackerConfig& tracker) {
  const auto kind = section.kind_of<TrackerKind>("kind", {{"simulated", TrackerKind::simulated},
                                                          {"usb", TrackerKind::usb},
                                                          {"tty", TrackerKind::tty},
                                                          {"tcp", TrackerKind::tcp},
                                                          {"replay", TrackerKind::replay}});
  if (!kind) return;
  tracker.kind = *kind;
  read_way(section, tracker);
  if (tracker.kind == TrackerKind::tcp) {
    tracker.baud = 0;
  } else {
    read_line(section, tracker);
  }
  tracker.rate_hz = section.number("rate_hz", {.min = 10, .max = 400, .fallback = 60});
  tracker.latency_ms = section.number("latency_ms", {.min = 0, .max = 100, .fallback = 0.0});
  read_tool(section, "scope", tracker.scope_rom, tracker.scope_port);
  read_tool(section, "reference", tracker.reference_rom, tracker.reference_port);
  tracker.second = section.has("second_rom") || section.has("second_port");
  if (tracker.second) read_tool(section, "second", tracker.second_rom, tracker.second_port);
  tracker.poll = section.choice_of<PollForm>(
      "poll",
      {{"auto", PollForm::automatic}, {"tx", PollForm::tx}, {"bx", PollForm::bx}, {"bx2", PollForm::bx2}},
      PollForm::automatic);
  tracker.beeps = static_cast<int>(section.integer("beeps", {.min = 0, .max = 9, .fallback = 0}));
  if (is_device(tracker.kind))
    tracker.marker_rms_mm =
        section.number("marker_rms_mm", {.min = 0.001, .max = 5, .fallback = kAssumedErrors.marker_rms_mm});
  tracker.max_error_mm = section.number("max_error_mm", {.min = 0, .max = 10, .fallback = 0.0});
}

Result<NdiSettings> settings_of(const TrackerConfig& tracker) {
  NdiSettings settings{.poll = tracker.poll,
                       .poll_rate_hz = tracker.rate_hz * kPollsPerFrame,
                       .device_rate_hz = tracker.rate_hz,
                       .baud = tracker.baud,
                       .flow = tracker.flow,
                       .beeps_when_tracking = tracker.beeps,
                       .max_error_mm = tracker.max_error_mm};
  std::vector<std::pair<std::filesystem::path, TrackedTool::Port>> tools{
      {tracker.scope_rom, tracker.scope_port}, {tracker.reference_rom, tracker.reference_port}};
  if (tracker.second) tools.emplace_back(tracker.second_rom, tracker.second_port);
  for (const auto& [file, port] : tools) {
    if (file.empty()) {
      settings.tools.emplace_back(port);
      continue;
    }
    auto tool = ndi::read_tool_definition(file);
    if (!tool) return tl::unexpected(tool.error());
    settings.tools.emplace_back(std::move(*tool));
  }
  if (auto distinct = check_distinct(settings.tools); !distinct) return tl::unexpected(distinct.error());
  if (auto checked = check(settings); !checked) return tl::unexpected(checked.error());
  return settings;
}

}  // namespace orcart
