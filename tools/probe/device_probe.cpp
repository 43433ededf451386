// Nodes in /dev, opened one by one.
#include "tools/probe/device_probe.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

#include "board/linux/encoder/evdev_encoder.hpp"
#include "board/linux/kms/drm_card.hpp"
#include "board/linux/pedal/keyboard_pedal.hpp"
#include "board/linux/pedal/requested_lines.hpp"
#include "board/linux/v4l2/camera_query.hpp"

namespace orcart {
namespace {

std::vector<std::string> nodes(const std::string& folder, const std::string& prefix) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with(prefix)) found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

/// "sentence; remedy" in two.
Finding lacking(std::string area, const std::string& sentence) {
  const auto split = sentence.find("; ");
  return {.area = std::move(area),
          .lack = sentence.substr(0, split),
          .next = split == std::string::npos ? "see the kernel's log (dmesg)" : sentence.substr(split + 2)};
}

bool is_known(std::uint32_t wire_code) {
  return std::ranges::any_of(
      std::array{WireFormat::yuyv, WireFormat::uyvy, WireFormat::nv12, WireFormat::mjpeg},
      [&](WireFormat known) { return static_cast<std::uint32_t>(known) == wire_code; });
}

Finding camera_on(const OpenDevice& device, const std::string& path) {
  const CameraOffer offer = offer_of(device);
  Finding finding{.area = "camera", .name = path + " " + offer.card + " (driver " + driver_of(device) + ")"};
  std::map<std::string, std::string> by_format;
  std::set<std::string> others;
  for (const CameraMode& mode : offer.modes) {
    const std::string format = name_of_code(mode.wire_code);
    if (!is_known(mode.wire_code)) {
      others.insert(format);
      continue;
    }
    std::string& modes = by_format[format];
    if (!modes.empty()) modes += "; ";
    modes += text_of(mode);
  }
  for (const auto& [format, modes] : by_format) {
    finding.details.push_back(format);
    finding.details.back().append(": ").append(modes);
  }
  if (!others.empty())
    finding.details.push_back("and " + std::to_string(others.size()) + " formats that orcart does not read");
  std::string controls;
  for (const CameraControl& control : controls_of(device))
    controls += (controls.empty() ? "" : ", ") + control.name + "=" + std::to_string(control.value) + " (" +
                std::to_string(control.min) + ".." + std::to_string(control.max) + ")";
  if (!controls.empty()) finding.details.push_back("controls: " + controls);
  return finding;
}

}  // namespace

std::optional<Finding> probe_camera(DeviceCalls& calls, const std::string& path) {
  const auto device = open_camera_node(calls, path);
  if (device) return camera_on(*device, path);
  const CameraTrouble& trouble = device.error();
  if (trouble.fault == PortFault::unsupported && !trouble.captures) return std::nullopt;
  return lacking("camera", trouble.sentence);
}

std::vector<Finding> probe_cameras() {
  std::vector<Finding> found;
  for (const std::string& path : nodes("/dev", "video"))
    if (auto finding = probe_camera(system_calls(), path)) found.push_back(std::move(*finding));
  if (found.empty())
    found.push_back({.area = "camera",
                     .lack = "no camera (/dev/video*) is here",
                     .next = "plug the camera unit's grabber in, and load its driver (uvcvideo)"});
  return found;
}

std::vector<Finding> probe_pedals() {
  std::vector<Finding> found;
  for (const GpioChipFacts& chip : gpio_chips()) {
    if (!chip.trouble.empty()) {
      found.push_back(lacking("pedal", chip.trouble));
      continue;
    }
    Finding finding{
        .area = "pedal",
        .name = chip.path + " " + chip.label + ", " + std::to_string(chip.lines.size()) + " lines"};
    for (const GpioLineFacts& line : chip.lines) {
      if (line.name.empty() && line.consumer.empty()) continue;
      finding.details.push_back("line " + std::to_string(line.number) +
                                (line.name.empty() ? "" : " \"" + line.name + "\"") +
                                (line.consumer.empty() ? "" : ", held by " + line.consumer));
    }
    found.push_back(std::move(finding));
  }
  for (const KeyboardFacts& keyboard : keyboards()) {
    if (keyboard.trouble.empty())
      found.push_back({.area = "pedal", .name = keyboard.path + " keyboard \"" + keyboard.name + "\""});
    else
      found.push_back(lacking("pedal", keyboard.trouble));
  }
  if (found.empty())
    found.push_back({.area = "pedal",
                     .lack = "no GPIO chip and no keyboard is here",
                     .next = "plug a USB pedal in, or load the driver of the board's GPIO chip"});
  return found;
}

std::vector<Finding> probe_encoders() {
  std::vector<Finding> found;
  for (const EncoderFacts& encoder : encoders()) {
    std::string axes = "axes:";
    for (const std::string& axis : encoder.axes) axes += " " + axis;
    found.push_back({.area = "encoder",
                     .name = encoder.path + " input device \"" + encoder.name + "\"",
                     .details = {axes}});
  }
  return found;
}

std::vector<Finding> probe_panels() {
  std::vector<Finding> found;
  for (const std::string& path : card_paths()) {
    const auto card = open_card(path);
    if (!card) {
      found.push_back(lacking("panel", card.error().message));
      continue;
    }
    const std::vector<DisplayConnector> connectors = connectors_of(card->get());
    Finding finding{.area = "panel", .name = path + ", " + std::to_string(connectors.size()) + " connectors"};
    for (const DisplayConnector& connector : connectors) {
      std::string modes;
      for (const DisplayMode& mode : connector.modes)
        modes += (modes.empty() ? "" : ", ") + text_of(mode) + (mode.preferred ? " (preferred)" : "");
      finding.details.push_back(connector.name +
                                (connector.connected ? ": " + modes : ": nothing connected"));
    }
    if (std::ranges::none_of(connectors, &DisplayConnector::connected)) {
      finding.lack = "no panel is connected to " + path;
      finding.next = "plug one in and switch it on";
    }
    found.push_back(std::move(finding));
  }
  if (found.empty())
    found.push_back({.area = "panel",
                     .lack = "no display card (/dev/dri/card0) is here",
                     .next = "load the card's driver; or use --panel window or png"});
  return found;
}

}  // namespace orcart
