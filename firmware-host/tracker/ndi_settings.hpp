// How the tracker is to be driven, and whether that can work over its line at all.
#pragma once

#include <cstdint>
#include <vector>

#include "board/ports/byte_link.hpp"
#include "firmware-host/tracker/ndi/baud.hpp"
#include "firmware-host/tracker/ndi/tool_definition.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

struct NdiSettings {
  std::vector<ndi::ToolDefinition> tools;  ///< loaded and checked; uploaded in this order
  double poll_rate_hz = 60;                ///< how often the driver asks
  double device_rate_hz = 60;              ///< how often the device measures
  std::uint32_t baud = 115200;             ///< the fastest to try; 0 for a network device, which has no line
  FlowControl flow = FlowControl::none;
  Nanos reset_patience = 7s;  ///< how long a device may take to come back from a break
  double max_error_mm = 0;    ///< a fit worse than this is doubtful; 0: the device's own limit will do
};

/// Bytes of one poll and its reply, when all tools are seen.
std::size_t poll_exchange_bytes(std::size_t tools) noexcept;
/// Those of the reply alone.
std::size_t poll_reply_bytes(std::size_t tools) noexcept;

/// Whether polls of so many tools at that rate leave a tenth of each period free at the baud.
bool rate_fits(std::size_t tools, double rate_hz, std::uint32_t baud) noexcept;

/// Refuses what cannot work, with the value and what would be accepted.
Result<void> check(const NdiSettings& settings);

}  // namespace orcart
