// The replies about port handles: PHRQ (a new one), PHSR (which there are), PHINF (what is behind one).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "firmware-host/tracker/ndi/tracking_reply.hpp"
#include "realtime/base/result.hpp"

namespace orcart::ndi {

struct PortHandle {
  std::uint8_t handle = 0;
  std::uint16_t status = 0;  ///< 3 hex digits: bits as in port_status_words
};

struct PortHandles {
  static constexpr std::size_t kMax = 64;
  std::array<PortHandle, kMax> list{};
  std::size_t count = 0;

  std::span<const PortHandle> all() const noexcept { return {list.data(), count}; }
};

/// The basic description of a tool; the texts are lent from the reply.
struct PortDescription {
  bool occupied = false;
  std::uint8_t main_type = 0;  ///< 1 reference, 2 probe, 3 button box, ...
  std::string_view manufacturer;
  std::string_view revision;
  std::string_view serial_number;
  std::uint8_t status = 0;
  std::string_view part_number;
};

/// Where a tool is plugged in: the reply to PHINF with kPortLocation.
struct PortLocation {
  bool wired = false;
  int port = 0;     ///< as printed on the device, from 1
  int channel = 0;  ///< of two sensors in one plug (Aurora): 1 is the first, 0 a single one
};
std::optional<PortLocation> parse_port_location(std::string_view text) noexcept;

std::optional<std::uint8_t> parse_new_handle(std::string_view text) noexcept;
Result<PortHandles, ReplyFault> parse_port_handles(std::string_view text) noexcept;
/// For the options kPortBasics, with or without kPartNumber.
Result<PortDescription, ReplyFault> parse_port_description(std::string_view text,
                                                           std::uint16_t options) noexcept;

}  // namespace orcart::ndi
