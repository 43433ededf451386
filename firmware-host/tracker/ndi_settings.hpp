// How the tracker is to be driven, and whether that can work over its line at all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "board/ports/byte_link.hpp"
#include "firmware-host/tracker/ndi/baud.hpp"
#include "firmware-host/tracker/ndi/tool_definition.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// How poses are asked for. All devices know TX, all but the oldest BX, the newest BX2 (Vega, Lyra).
enum class PollForm : std::uint8_t {
  automatic,  ///< BX2 where the device has it and the line bears it, else BX; the next simpler where that is
              ///< refused
  tx,
  bx,
  bx2,
};

/// A tool to follow: a wireless one by its definition, which is uploaded, or a wired one by its port.
struct TrackedTool {
  TrackedTool(ndi::ToolDefinition wireless) : definition(std::move(wireless)) {}
  struct Port {
    int number = 1;   ///< as printed on the device, from 1
    int channel = 0;  ///< Aurora's plugs with two sensors: 1 or 2
  };
  explicit TrackedTool(const Port& port) : wired(port) {}

  ndi::ToolDefinition definition;
  std::optional<Port> wired;

  /// What a sentence calls it.
  std::string name() const;
  /// A wired tool's kind stands in its own memory; it is tracked as one that moves.
  ndi::TrackingPriority priority() const noexcept {
    return wired ? ndi::TrackingPriority::moving : definition.priority();
  }
};

/// Polls at the device's own rate would find each frame equally old, by up to a period, and no clock fit
/// could know by how much. A little faster, and every second one comes just after the frame it asks for;
/// one poll in 60 finds the frame before once more.
constexpr double kPollsPerFrame = 1 + 1.0 / 60;

struct NdiSettings {
  std::vector<TrackedTool> tools;  ///< loaded and checked; uploaded in this order
  PollForm poll = PollForm::automatic;
  double poll_rate_hz = 60;     ///< how often the driver asks
  double device_rate_hz = 60;   ///< how often the device measures
  std::uint32_t baud = 115200;  ///< the fastest to try; 0 for a network device, which has no line
  FlowControl flow = FlowControl::none;
  Nanos reset_patience = 7s;    ///< how long a device may take to come back from a break
  int beeps_when_tracking = 0;  ///< 0 to 9, so that a person hears that all tools are loaded
  double max_error_mm = 0;      ///< a fit worse than this is doubtful; 0: the device's own limit will do
};

/// Bytes of one poll and its reply, when all tools are seen; for `automatic` those of BX.
std::size_t poll_exchange_bytes(std::size_t tools, PollForm form) noexcept;
/// Those of the reply alone.
std::size_t poll_reply_bytes(std::size_t tools, PollForm form = PollForm::automatic) noexcept;

/// Whether polls of so many tools at that rate leave a tenth of each period free at the baud.
struct PollLoad {
  std::size_t tools = 1;
  double rate_hz = 60;
  PollForm form = PollForm::automatic;
};
bool rate_fits(const PollLoad& load, std::uint32_t baud) noexcept;
PollLoad load_of(const NdiSettings& settings) noexcept;

/// Refuses what cannot work, with the value and what would be accepted.
Result<void> check(const NdiSettings& settings);

}  // namespace orcart
