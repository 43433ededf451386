// A host that talks to the emulated tracker by hand, without a driver.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "board/sim/ndi/ndi_emulator.hpp"
#include "realtime/base/crc16.hpp"

namespace orcart::testing {

class StillTool final : public ToolMotion {
 public:
  TrueToolPose pose_of(int tool, Instant) const noexcept override {
    TrueToolPose pose;
    pose.translation_mm = {1.0 * tool, 2, -1500};
    pose.visible = visible;
    return pose;
  }
  bool visible = true;
};

class EmulatedSession {
 public:
  explicit EmulatedSession(NdiEmulatorSettings settings = {.has_line = false}) : device(settings, motion) {}

  /// All bytes of the reply to raw bytes.
  std::string raw(std::string_view bytes) {
    device.receive(std::as_bytes(std::span{bytes.data(), bytes.size()}), now);
    return collect(1s);
  }
  /// The reply to a command with its CRC, without CRC and carriage return where it is text.
  std::string ask(std::string_view command) {
    std::string line(command);
    const unsigned crc = crc16(command);
    for (int shift = 12; shift >= 0; shift -= 4) line += "0123456789ABCDEF"[crc >> shift & 0xFu];
    const std::string reply = raw(line + '\r');
    const bool is_text = reply.size() >= 5 && reply.back() == '\r' && !reply.starts_with("\xC4\xA5");
    return is_text ? reply.substr(0, reply.size() - 5) : reply;
  }
  std::string collect(Nanos time) {
    now += time;
    std::string text(8192, '\0');
    text.resize(device.read(std::as_writable_bytes(std::span{text}), now));
    return text;
  }
  /// Uploads a definition; the handle.
  std::string upload(std::span<const std::byte> definition) {
    const std::string handle = ask("PHRQ:*********1****");
    for (std::size_t at = 0; at < 1024; at += 64) {
      std::string block = "PVWR:" + handle + hex(at, 4);
      for (std::size_t i = at; i < at + 64; ++i) {
        block += hex(i < definition.size() ? std::to_integer<unsigned>(definition[i]) : 0, 2);
      }
      if (ask(block) != "OKAY") return "refused";
    }
    return handle;
  }
  static std::string hex(std::size_t value, int digits) {
    std::string text;
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4)
      text += "0123456789ABCDEF"[value >> shift & 0xFu];
    return text;
  }

  StillTool motion;
  NdiEmulator device;
  Instant now = instant_from_nanos(5'000'000'000);
};

/// A definition with the given markers, made here so that emulator and driver do not share their reading of
/// it.
std::vector<std::byte> definition_of(std::span<const std::array<float, 3>> markers_mm);

}  // namespace orcart::testing
