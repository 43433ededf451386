// The emulated tracker while it tracks: the newest frame's poses as TX, BX and BX2 tell them.
#include <algorithm>

#include "board/sim/ndi/ndi_emulator.hpp"

namespace orcart {
namespace {

constexpr std::uint16_t kTransforms = 0x0001;
constexpr std::uint16_t kToolInformation = 0x0002;
constexpr std::uint16_t kSingleStray = 0x0004;
constexpr std::uint16_t kMarkerPositions = 0x0008;
constexpr std::uint16_t kPassiveStrays = 0x1000;
constexpr std::uint32_t kWrongHandleOffset = 0x40;

constexpr std::uint32_t kHandleValid = 1;
constexpr std::uint32_t kHandleMissing = 2;
constexpr std::uint32_t kHandleDisabled = 4;

/// w x y z with w not negative, as trackers choose between the two signs.
std::array<double, 4> quaternion_of(const MarkerFit& fit) {
  const double sign = fit.rotation.w() < 0 ? -1.0 : 1.0;
  return {sign * fit.rotation.w(), sign * fit.rotation.x(), sign * fit.rotation.y(), sign * fit.rotation.z()};
}

void put_floats(const MarkerFit& fit, WireText& reply) {
  for (const double part : quaternion_of(fit)) reply.f32(part);
  for (const double part : fit.translation_mm) reply.f32(part);
  reply.f32(fit.error_mm);
}

void put_decimals(const MarkerFit& fit, WireText& reply) {
  for (const double part : quaternion_of(fit)) reply.signed_decimal(part * 1e4, 6);
  for (const double part : fit.translation_mm) reply.signed_decimal(part * 1e2, 7);
  reply.signed_decimal(fit.error_mm * 1e4, 6);
}

/// Options of TX and BX; 0001 where none are given.
std::optional<std::uint16_t> options_in(std::string_view arguments) {
  if (arguments.empty()) return kTransforms;
  const auto options = parse_hex_field(arguments);
  if (arguments.size() != 4 || !options) return std::nullopt;
  return static_cast<std::uint16_t>(*options);
}

/// General Binary Format: a component's type, size (its own 12 bytes included), item option and item count.
/// Returns where the size stands, to be patched once it is known.
std::size_t begin_component(std::uint32_t type, std::uint32_t items, WireText& reply) {
  reply.u16(type);
  const std::size_t size_at = reply.size();
  reply.u32(0);
  reply.u16(0);
  reply.u32(items);
  return size_at;
}

void end_component(std::size_t size_at, WireText& reply) {
  reply.patch_u32(size_at, static_cast<std::uint32_t>(reply.size() - size_at + 2));
}

}  // namespace

std::uint32_t NdiEmulator::reported_ports() const noexcept {
  return static_cast<std::uint32_t>(
      std::count_if(ports_.begin(), ports_.end(), [](const EmulatedPort& port) { return port.reported(); }));
}

NdiEmulator::Moment NdiEmulator::moment_at(Instant now) const noexcept {
  const auto* frozen = faults_.active(NdiFault::frozen_frame, now, replies_sent_);
  const Instant seen_at = (frozen != nullptr ? frozen->from : now) - settings_.device_latency;
  const std::uint32_t frame = clock_.newest_at(seen_at);
  const std::string_view share =
      model_.has_frames ? "Param.Tracking.Track Frequency" : "Param.Tracking.Illuminator Rate";
  const std::uint32_t told = static_cast<std::uint32_t>(3 - parameters_.value(share));
  const std::uint32_t each = settings_.measures_each != 0 ? settings_.measures_each : told;
  return {.now = now, .frame = frame - frame % each};  // one in `each` is reported; all are numbered
}

std::uint16_t NdiEmulator::system_status(Instant now) const noexcept {
  constexpr std::uint16_t kInfrared = 0x0002, kAlertsPending = 0x0100;
  std::uint16_t status = port_events_;
  if (faults_.active(NdiFault::infrared, now, replies_sent_) != nullptr) status |= kInfrared;
  // A bit of the generation that has parameters to ask for the alerts with.
  if (model_.has_parameters && self_report_.unread() != 0) status |= kAlertsPending;
  return status;
}

NdiEmulator::ToolReading NdiEmulator::reading_of(std::size_t port, const Moment& moment) const noexcept {
  const bool wrong = faults_.active(NdiFault::wrong_handle, moment.now, replies_sent_) != nullptr;
  const auto number = static_cast<std::uint32_t>(port) + 1 + (wrong ? kWrongHandleOffset : 0);
  ToolReading tool{.handle = static_cast<std::uint8_t>(number), .status = ports_[port].status()};
  tool.disabled = !ports_[port].enabled();
  const Instant measured_at = clock_.measured_at(moment.frame);
  const TrueToolPose truth = motion_.pose_of(static_cast<int>(port), measured_at);
  tool.missing = !truth.visible || measured_at < tracking_since_;
  if (!tool.disabled && !tool.missing) {
    tool.fit =
        measure_tool(ports_[port].markers_mm(), truth, settings_.noise, static_cast<int>(port), moment.frame);
  }
  return tool;
}

NdiError NdiEmulator::on_tstart(std::string_view arguments, const Moment& moment) noexcept {
  if (arguments == "80") frame_zero_ = moment.frame;
  tracking_ = true;
  tracking_since_ = moment.now;
  last_bx2_frame_ = 0;
  return okay();
}

NdiError NdiEmulator::on_tstop(std::string_view, const Moment&) noexcept {
  tracking_ = false;
  return okay();
}

void NdiEmulator::put_tx_tool(const ToolReading& tool, std::size_t port, std::uint16_t options,
                              const Moment& moment) noexcept {
  reply_.hex(tool.handle, 2);
  if (tool.disabled) {
    reply_.text("DISABLED\n");
    return;
  }
  if ((options & kTransforms) != 0) {
    if (tool.missing) {
      reply_.text("MISSING");
    } else {
      put_decimals(tool.fit, reply_);
    }
    reply_.hex(tool.status, 8);
    reply_.hex(frame_number(moment.frame), 8);
  }
  if ((options & kToolInformation) != 0) reply_.text("0000000000000000000000");
  if ((options & kSingleStray) != 0) reply_.text("00");
  if ((options & kMarkerPositions) != 0) {
    const auto markers = tool.missing ? std::span<const Eigen::Vector3d>{} : ports_[port].markers_mm();
    reply_.hex(static_cast<std::uint32_t>(markers.size()), 2);
    for (std::size_t i = 0; i < markers.size(); i += 4) reply_.text("0");
    for (const Eigen::Vector3d& marker : markers) {
      const Eigen::Vector3d at_mm = tool.fit.rotation * marker + tool.fit.translation_mm;
      for (const double part : at_mm) reply_.signed_decimal(part * 1e2, 7);
    }
  }
  reply_.text("\n");
}

NdiError NdiEmulator::on_tx(std::string_view arguments, const Moment& moment) noexcept {
  const auto options = options_in(arguments);
  if (!options) return NdiError::out_of_range;
  reply_.hex(reported_ports(), 2);
  for (std::size_t i = 0; i < kMaxPorts; ++i) {
    if (ports_[i].reported()) put_tx_tool(reading_of(i, moment), i, *options, moment);
  }
  if ((*options & kPassiveStrays) != 0) reply_.text("00");
  reply_.hex(system_status(moment.now), 4);
  return NdiError::none;
}

void NdiEmulator::put_bx_tool(const ToolReading& tool, std::size_t port, std::uint16_t options,
                              const Moment& moment) noexcept {
  reply_.u8(tool.handle);
  if (tool.disabled) {
    reply_.u8(kHandleDisabled);
    return;
  }
  reply_.u8(tool.missing ? kHandleMissing : kHandleValid);
  if ((options & kTransforms) != 0) {
    if (!tool.missing) put_floats(tool.fit, reply_);
    reply_.u32(tool.status);
    reply_.u32(frame_number(moment.frame));
  }
  for (int i = 0; (options & kToolInformation) != 0 && i < 11; ++i) reply_.u8(0);
  if ((options & kSingleStray) != 0) reply_.u8(0);
  if ((options & kMarkerPositions) != 0) {
    const auto markers = tool.missing ? std::span<const Eigen::Vector3d>{} : ports_[port].markers_mm();
    reply_.u8(static_cast<std::uint32_t>(markers.size()));
    for (std::size_t i = 0; i < markers.size(); i += 8) reply_.u8(0);
    for (const Eigen::Vector3d& marker : markers) {
      const Eigen::Vector3d at_mm = tool.fit.rotation * marker + tool.fit.translation_mm;
      for (const double part : at_mm) reply_.f32(part);
    }
  }
}

NdiError NdiEmulator::on_bx(std::string_view arguments, const Moment& moment) noexcept {
  const auto options = options_in(arguments);
  if (!options) return NdiError::out_of_range;
  binary_reply_ = true;
  reply_.u8(reported_ports());
  for (std::size_t i = 0; i < kMaxPorts; ++i) {
    if (ports_[i].reported()) put_bx_tool(reading_of(i, moment), i, *options, moment);
  }
  if ((*options & kPassiveStrays) != 0) reply_.u8(0);
  reply_.u16(system_status(moment.now));
  return NdiError::none;
}

void NdiEmulator::put_six_d(const Moment& moment) noexcept {
  constexpr std::uint32_t kMissing = 0x0100 | 31;
  constexpr std::uint32_t kNotEnabled = 0x0100 | 32;
  constexpr std::uint32_t kUnplugged = 0x0100 | 33;
  const std::size_t size_at = begin_component(2, reported_ports(), reply_);
  for (std::size_t i = 0; i < kMaxPorts; ++i) {
    if (!ports_[i].reported()) continue;
    const ToolReading tool = reading_of(i, moment);
    reply_.u16(tool.handle);
    if (tool.disabled || tool.missing) {
      const std::uint32_t disabled = ports_[i].occupied() ? kNotEnabled : kUnplugged;
      reply_.u16(tool.disabled ? disabled : kMissing);
    } else {
      reply_.u16(0);
      put_floats(tool.fit, reply_);
    }
  }
  end_component(size_at, reply_);
}

void NdiEmulator::put_three_d(const Moment& moment) noexcept {
  const std::size_t size_at = begin_component(3, reported_ports(), reply_);
  for (std::size_t i = 0; i < kMaxPorts; ++i) {
    if (!ports_[i].reported()) continue;
    const ToolReading tool = reading_of(i, moment);
    const bool seen = !tool.disabled && !tool.missing;
    const auto markers = seen ? ports_[i].markers_mm() : std::span<const Eigen::Vector3d>{};
    reply_.u16(tool.handle);
    reply_.u16(static_cast<std::uint32_t>(markers.size()));
    for (std::size_t m = 0; m < markers.size(); ++m) {
      const Eigen::Vector3d at_mm = tool.fit.rotation * markers[m] + tool.fit.translation_mm;
      reply_.u16(0);  // status, reserved
      reply_.u16(static_cast<std::uint32_t>(m));
      for (const double part : at_mm) reply_.f32(part);
    }
  }
  end_component(size_at, reply_);
}

void NdiEmulator::put_alerts() noexcept {
  const std::size_t size_at = begin_component(0x12, self_report_.count(), reply_);
  self_report_.put_items(reply_);
  end_component(size_at, reply_);
}

NdiError NdiEmulator::on_bx2(std::string_view arguments, const Moment& moment) noexcept {
  constexpr std::uint32_t kGbfVersion = 1;
  constexpr std::uint32_t kPassiveFrame = 2;
  const bool six_d = arguments.find("--6d=none") == std::string_view::npos;
  const bool three_d = arguments.find("--3d=tools") != std::string_view::npos ||
                       arguments.find("--3d=all") != std::string_view::npos;
  const bool fresh = moment.frame != last_bx2_frame_;
  last_bx2_frame_ = moment.frame;
  binary_reply_ = true;
  reply_.u16(kGbfVersion);
  reply_.u16(fresh ? 1 : 0);
  if (!fresh) return NdiError::none;  // a frame is told once
  const std::size_t size_at = begin_component(1, 1, reply_);
  const auto stamp = nanos_since_zero(clock_.measured_at(moment.frame));
  reply_.u8(kPassiveFrame);
  reply_.u8(moment.frame & 0xFFu);
  reply_.u16(0);
  reply_.u32(frame_number(moment.frame));
  reply_.u32(static_cast<std::uint32_t>(stamp / 1'000'000'000));
  reply_.u32(static_cast<std::uint32_t>(stamp % 1'000'000'000));
  reply_.u16(kGbfVersion);
  const bool alerts = self_report_.count() > 0;
  reply_.u16((six_d ? 1u : 0u) + (three_d ? 1u : 0u) + (alerts ? 1u : 0u));
  if (six_d) put_six_d(moment);
  if (three_d) put_three_d(moment);
  if (alerts) put_alerts();
  end_component(size_at, reply_);
  return NdiError::none;
}

}  // namespace orcart
