// The emulated tracker's commands about the system as a whole.
#include <algorithm>
#include <cmath>

#include "board/sim/ndi/ndi_emulator.hpp"

namespace orcart {
namespace {

/// As real devices lay it out, so that clients which look for a line find it.
void put_version(const EmulatedModel& model, WireText& reply) noexcept {
  reply.text(model.family);
  reply.text(
      " Control Firmware, simulated by orcart\nNDI S/N: P0-00001\nCharacterization Date: 01/01/00\nFreeze "
      "Tag: ");
  reply.text(model.firmware);
  reply.text("\nFreeze Date: 01/01/00\n(C) orcart, Apache-2.0\n");
}

std::uint32_t baud_of_code(char code) noexcept {
  constexpr std::array<std::uint32_t, 8> kBauds{9600, 14400, 19200, 38400, 57600, 115200, 921600, 1228739};
  if (code == 'A') return 230400;
  return code >= '0' && code <= '7' ? kBauds[static_cast<std::size_t>(code - '0')] : 0;
}

bool within(char letter, char last) noexcept {
  return letter >= '0' && letter <= last;
}

}  // namespace

NdiError NdiEmulator::on_init(std::string_view, const Moment&) noexcept {
  for (EmulatedPort& port : ports_) port.release();
  const auto occupied = [](const EmulatedPort& port) { return port.occupied(); };
  std::copy_if(plugged_in_.begin(), plugged_in_.end(), ports_.begin(), occupied);
  initialised_ = true;
  tracking_ = false;
  return okay();
}

NdiError NdiEmulator::on_comm(std::string_view arguments, const Moment&) noexcept {
  if (arguments.size() != 5) return NdiError::wrong_parameters;
  const std::uint32_t baud = baud_of_code(arguments[0]);
  const bool known = within(arguments[1], '1') && within(arguments[2], '2') && within(arguments[3], '1') &&
                     within(arguments[4], '1');
  if (baud == 0 || baud > model_.fastest_baud || !known) return NdiError::line_setting;
  next_baud_ = baud;
  return okay();
}

NdiError NdiEmulator::on_ver(std::string_view arguments, const Moment&) noexcept {
  if (arguments == "5") {
    reply_.text("001");
  } else if (arguments.size() == 1 && within(arguments[0], '8')) {
    put_version(model_, reply_);
  } else {
    return arguments.empty() ? NdiError::wrong_parameters : NdiError::out_of_range;
  }
  return NdiError::none;
}

NdiError NdiEmulator::on_apirev(std::string_view, const Moment&) noexcept {
  reply_.text(model_.api_revision);
  return NdiError::none;
}

NdiError NdiEmulator::on_sflist(std::string_view arguments, const Moment&) noexcept {
  const auto list = parse_hex_field(arguments);
  if (!list || arguments.size() != 2) return NdiError::wrong_parameters;
  switch (*list) {
    case 0:
      reply_.text("00000002");
      return NdiError::none;  // passive ports only
    case 1:
      reply_.text("0");
      return NdiError::none;  // active ports
    case 2:
      reply_.hex(static_cast<std::uint32_t>(kMaxPorts), 2);
      return NdiError::none;
    case 3:
      reply_.text("0");
      return NdiError::none;  // volumes are told by GET
    case 4:
      reply_.text("0");
      return NdiError::none;  // active wireless ports
    case 5:
      reply_.hex(static_cast<std::uint32_t>(kMaxPorts), 2);
      return NdiError::none;
    default:
      return NdiError::out_of_range;
  }
}

NdiError NdiEmulator::on_sstat(std::string_view arguments, const Moment&) noexcept {
  const auto options = parse_hex_field(arguments);
  if (!options || arguments.size() != 4) return NdiError::wrong_parameters;
  for (std::uint32_t bit = 1; bit <= 0x10; bit <<= 1) {
    if ((*options & bit) != 0) reply_.text("00");
  }
  return NdiError::none;
}

void NdiEmulator::refresh_parameters() noexcept {
  parameters_.assign("Info.Status.Alerts", self_report_.standing());
  parameters_.assign("Info.Status.New Alerts", self_report_.unread());
  parameters_.assign("Info.Status.Bump Detected", self_report_.bumped() ? 1 : 0);
  parameters_.assign("Param.Bump Detector.Bumped", self_report_.bumped() ? 1 : 0);
}

NdiError NdiEmulator::on_get(std::string_view arguments, const Moment&) noexcept {
  refresh_parameters();
  if (arguments == "Info.Status.New Alerts") self_report_.read();  // told once
  return parameters_.get(arguments, reply_);
}

NdiError NdiEmulator::on_getinfo(std::string_view arguments, const Moment&) noexcept {
  refresh_parameters();
  return parameters_.describe(arguments, reply_);
}

NdiError NdiEmulator::on_set(std::string_view arguments, const Moment&) noexcept {
  const bool frames = arguments.starts_with("Param.Tracking.Frame Frequency=");
  if (frames && tracking_) return NdiError::wrong_mode;
  const NdiError error = parameters_.set(arguments);
  if (error != NdiError::none) return error;
  const std::int64_t rate_hz = parameters_.value("Param.Tracking.Frame Frequency");
  if (frames && rate_hz != std::llround(frame_rate_hz_)) run_frames_at(static_cast<double>(rate_hz));
  if (arguments.starts_with("Param.Simulated Alerts="))
    self_report_.simulate(static_cast<std::uint32_t>(parameters_.value("Param.Simulated Alerts")));
  if (arguments == "Param.Bump Detector.Clear=1") self_report_.clear_bump();
  return okay();
}

NdiError NdiEmulator::on_beep(std::string_view arguments, const Moment& moment) noexcept {
  constexpr Nanos kBeep = 200ms;
  if (arguments.size() != 1 || arguments[0] < '1' || arguments[0] > '9') return NdiError::out_of_range;
  const bool busy = moment.now < beeping_until_;
  reply_.text(busy ? "0" : "1");
  if (busy) return NdiError::none;
  const int beeps = arguments[0] - '0';
  beeps_heard_ += static_cast<std::uint64_t>(beeps);
  beeping_until_ = moment.now + beeps * kBeep;
  return NdiError::none;
}

NdiError NdiEmulator::on_irate(std::string_view arguments, const Moment&) noexcept {
  if (settings_.measures_each != 0) return NdiError::invalid_command;
  if (arguments.size() != 1 || !within(arguments[0], '2')) return NdiError::out_of_range;
  if (model_.has_frames) parameters_.assign("Param.Tracking.Track Frequency", arguments[0] - '0');
  parameters_.assign("Param.Tracking.Illuminator Rate", arguments[0] - '0');
  return okay();
}

NdiError NdiEmulator::on_irchk(std::string_view, const Moment& moment) noexcept {
  reply_.text((system_status(moment.now) & 0x0002u) != 0 ? "1" : "0");
  return NdiError::none;
}

NdiError NdiEmulator::on_echo(std::string_view arguments, const Moment&) noexcept {
  reply_.text(arguments);
  return NdiError::none;
}

NdiError NdiEmulator::on_reset(std::string_view, const Moment& moment) noexcept {
  restart(moment.now);
  return NdiError::none;
}

NdiError NdiEmulator::on_accepted(std::string_view, const Moment&) noexcept {
  return okay();
}

}  // namespace orcart
