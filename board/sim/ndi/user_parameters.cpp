// The table of named parameters.
#include "board/sim/ndi/user_parameters.hpp"

#include <charconv>
#include <cmath>

namespace orcart {
namespace {

enum class Access : std::uint8_t { read, write };

/// Numbers where `text` is empty.
struct Row {
  std::string_view name;
  std::string_view text;
  std::int64_t value;
  std::int64_t minimum;
  std::int64_t maximum;
  Access access;
  std::string_view choices;
  std::string_view description;
};

constexpr std::int64_t kAnyBits = 0x7FFF'FFFF;
constexpr auto kRows = std::to_array<Row>({
    {"Features.Firmware.Version", "?", 0, 0, 0, Access::read, "", "Current firmware revision"},
    {"Features.Firmware.API Revision", "?", 0, 0, 0, Access::read, "", "Revision of the protocol"},
    {"Features.Hardware.Model", "?", 0, 0, 0, Access::read, "", "Model of the device"},
    {"Features.Hardware.Serial Number", "P0-00001", 0, 0, 0, Access::read, "", "Serial number"},
    {"Features.Tools.Enabled Tools", "", 16, 16, 16, Access::read, "", "Tools that can be enabled at once"},
    {"Features.Tools.Active Ports", "", 0, 0, 0, Access::read, "", "Ports for active wired tools"},
    {"Features.Tools.Passive Ports", "", 16, 16, 16, Access::read, "", "Handles for passive tools"},
    {"Features.Tools.Wireless Ports", "", 16, 16, 16, Access::read, "", "Wireless port handles"},
    {"Param.Tracking.Available Volumes", "Simulated Volume", 0, 0, 0, Access::read, "",
     "Measurement volumes"},
    {"Param.Tracking.Selected Volume", "", 0, 0, 0, Access::write, "0", "Index of the selected volume"},
    {"Param.Tracking.Frame Frequency", "", 60, 10, 400, Access::write, "", "Frames in a second"},
    {"Param.Tracking.Track Frequency", "", 2, 0, 2, Access::write, "1/3,1/2,1/1", "Share of frames reported"},
    {"Param.Tracking.Sensitivity", "", 4, 1, 7, Access::write, "", "Sensitivity of the sensors"},
    {"Param.Tracking.Illuminator Rate", "", 2, 0, 2, Access::write, "20,30,60", "Illuminator rate"},
    {"Param.Data Averaging.Depth", "", 1, 1, 100, Access::write, "", "Samples averaged"},
    {"Param.Bump Detector.Bump Detection", "", 1, 0, 1, Access::write, "", "Whether knocks are noticed"},
    {"Param.Bump Detector.Clear", "", 0, 0, 1, Access::write, "", "1 forgets the knock"},
    {"Param.Bump Detector.Bumped", "", 0, 0, 1, Access::read, "", "The sensor was knocked"},
    {"Param.System Beeper", "", 1, 0, 1, Access::write, "", "Beeps at start"},
    {"Param.Watch Dog Timer", "", 0, 0, 65535, Access::write, "", "Seconds without a command"},
    {"Param.Simulated Alerts", "", 0, 0, kAnyBits, Access::write, "", "Alerts to be told without a reason"},
    {"Info.Status.System Mode", "Initialized", 0, 0, 0, Access::read, "", "Mode of the system"},
    {"Info.Status.Alerts", "", 0, 0, kAnyBits, Access::read, "", "Alerts that stand"},
    {"Info.Status.New Alerts", "", 0, 0, kAnyBits, Access::read, "", "Alerts not asked for yet"},
    {"Info.Status.Bump Detected", "", 0, 0, 1, Access::read, "", "The sensor was knocked"},
    {"Info.Status.New Log Entry", "", 0, 0, 1, Access::read, "", "The log has grown"},
    {"Config.Password", "", 0, 0, 0, Access::read, "", "Not kept by the emulator"},
    {"Config.Combined Firmware Revision", "", 1, 1, 1, Access::read, "", "Combined firmware revision"},
    {"Device.Type.0", "PS", 0, 0, 0, Access::read, "", "Position sensor"},
    {"Device.Instance.0", "", 0, 0, 0, Access::read, "", "Instance of the device"},
});

void put_value(const Row& row, std::string_view text, std::int64_t value, WireText& reply) noexcept {
  reply.text(row.name);
  reply.text("=");
  if (text.empty()) {
    reply.decimal(value);
  } else {
    reply.text(text);
  }
}

int index_of(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (kRows[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

UserParameters::UserParameters(const EmulatedModel& model, double frame_rate_hz) noexcept {
  static_assert(kRows.size() == kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    values_[i] = kRows[i].value;
    texts_[i] = kRows[i].text;
  }
  texts_[0] = model.firmware;
  texts_[1] = model.api_revision;
  texts_[2] = model.family;
  assign("Param.Tracking.Frame Frequency", std::llround(frame_rate_hz));
}

void UserParameters::assign(std::string_view name, std::int64_t value) noexcept {
  if (const int index = index_of(name); index >= 0) values_[static_cast<std::size_t>(index)] = value;
}

std::int64_t UserParameters::value(std::string_view name) const noexcept {
  const int index = index_of(name);
  return index < 0 ? 0 : values_[static_cast<std::size_t>(index)];
}

NdiError UserParameters::get(std::string_view name, WireText& reply) const noexcept {
  const bool many = name.ends_with('*');
  if (many) name.remove_suffix(1);
  bool found = false;
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool wanted = many ? kRows[i].name.starts_with(name) : kRows[i].name == name;
    if (!wanted) continue;
    if (found) reply.text("\n");
    put_value(kRows[i], texts_[i], values_[i], reply);
    found = true;
  }
  return found ? NdiError::none : NdiError::no_such_parameter;
}

NdiError UserParameters::describe(std::string_view name, WireText& reply) const noexcept {
  const bool many = name.ends_with('*');
  if (many) name.remove_suffix(1);
  bool found = false;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Row& row = kRows[i];
    if (many ? !row.name.starts_with(name) : row.name != name) continue;
    if (found) reply.text("\n");
    found = true;
    put_value(row, texts_[i], values_[i], reply);
    reply.text(texts_[i].empty() ? ";1;" : ";4;");
    reply.text(row.access == Access::write ? "2;" : "0;");
    reply.decimal(row.minimum);
    reply.text(";");
    reply.decimal(row.maximum);
    reply.text(";");
    reply.text(row.choices);
    reply.text(";");
    reply.text(row.description);
  }
  return found ? NdiError::none : NdiError::no_such_parameter;
}

NdiError UserParameters::set(std::string_view assignment) noexcept {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) return NdiError::wrong_parameters;
  const int index = index_of(assignment.substr(0, equals));
  if (index < 0) return NdiError::no_such_parameter;
  const Row& row = kRows[static_cast<std::size_t>(index)];
  if (row.access == Access::read) return NdiError::read_only;
  const std::string_view digits = assignment.substr(equals + 1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return NdiError::wrong_value_type;
  if (value < row.minimum || value > row.maximum) return NdiError::value_out_of_range;
  values_[static_cast<std::size_t>(index)] = value;
  return NdiError::none;
}

}  // namespace orcart
