// What one TX or BX reply says about each handle, as the device says it: no tool names, no judgement.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware-host/tracker/ndi/system_alerts.hpp"
#include "realtime/base/result.hpp"

namespace orcart::ndi {

enum class HandleStatus : std::uint8_t { valid = 1, missing = 2, disabled = 4 };

struct HandleReading {
  std::uint8_t handle = 0;
  HandleStatus status = HandleStatus::missing;
  bool has_transform = false;             ///< valid, and transforms were asked for
  std::array<float, 4> quaternion{};      ///< w x y z: marker body to tracker
  std::array<float, 3> translation_mm{};  ///< the body's origin in tracker space
  float error_mm = 0;                     ///< RMS of the device's own marker fit
  std::uint32_t port_status = 0;          ///< 0 where the device sent none (disabled)
  std::uint32_t frame = 0;                ///< likewise
  std::uint8_t tool_code = 0;             ///< BX2's reason, as in tool_status_word(); 0 elsewhere
};

enum class ReplyFault : std::uint8_t {
  truncated,         ///< ends in the middle of an item
  trailing,          ///< goes on after its last item
  too_many_handles,  ///< more than a device has
  bad_number,        ///< a field that is no number, or a status that does not exist
};

struct TrackingReply {
  static constexpr std::size_t kMaxHandles = 24;
  std::array<HandleReading, kMaxHandles> handles{};
  std::size_t count = 0;
  std::uint16_t system_status = 0;
  bool has_frame = true;  ///< false: BX2 had nothing new to tell
  SystemAlerts alerts;    ///< BX2 alone tells them with the poses

  std::span<const HandleReading> readings() const noexcept { return {handles.data(), count}; }
};

/// `body` is the payload of a BX reply, `options` those of the command. Any bytes are safe; allocates
/// nothing.
Result<TrackingReply, ReplyFault> parse_bx(std::span<const std::byte> body, std::uint16_t options) noexcept;

/// `body` is the payload of a BX2 reply: frames of several kinds of tools, each tool once, and alerts. What
/// is not known is passed over. Port status is made of the tool's code. Any bytes are safe; allocates
/// nothing.
Result<TrackingReply, ReplyFault> parse_bx2(std::span<const std::byte> body) noexcept;

/// `text` is the payload of a TX reply; quaternions / 10000, millimetres / 100, error / 10000. Any bytes are
/// safe.
Result<TrackingReply, ReplyFault> parse_tx(std::string_view text, std::uint16_t options) noexcept;

}  // namespace orcart::ndi
