// What can be wrong between the driver and its tracker, as a code that costs nothing, and in words.
#pragma once

#include <cstdint>
#include <string_view>

namespace orcart {

enum class TrackerTrouble : std::uint8_t {
  none,
  not_answering,   ///< nothing answers the probe, not even after a break
  device_refuses,  ///< the device answered a command of the start with an error
  tool_absent,     ///< a wired tool is not in its port
  bad_answer,      ///< the device answered a command of the start with something else
  silent,          ///< replies have stopped coming
  bad_crc,         ///< 3 damaged replies in a row, or 1 % of them in 10 s
  frame_stuck,     ///< replies come, but the device measures nothing new
  device_reset,    ///< the device restarted, or forgot that it was tracking
  disconnected,    ///< the link is gone
};

/// The trouble with what stands behind it, for another thread: so small that it is handed over in one piece.
struct TrackerState {
  TrackerTrouble trouble = TrackerTrouble::none;
  std::uint8_t error_code = 0;     ///< of the ERRORhh behind it; 0 where none is
  std::int8_t tool = -1;           ///< that it is about; -1 where about none
  std::int8_t disabled_tool = -1;  ///< the first that the device does not track, while it tracks
  std::uint16_t port_status = 0;   ///< of that tool
  std::uint16_t slow_hz = 0;       ///< what the device measures at where that is less than wished; else 0

  bool operator==(const TrackerState&) const = default;
};
static_assert(sizeof(TrackerState) == 8);

/// The device answers, but will not do as it is told: no cable's fault.
constexpr bool refuses(TrackerTrouble trouble) noexcept {
  return trouble == TrackerTrouble::device_refuses || trouble == TrackerTrouble::tool_absent ||
         trouble == TrackerTrouble::bad_answer;
}

constexpr std::string_view word_for(TrackerTrouble trouble) noexcept {
  switch (trouble) {
    case TrackerTrouble::none:
      return "fine";
    case TrackerTrouble::not_answering:
      return "no tracker answers on the line";
    case TrackerTrouble::device_refuses:
      return "the tracker refuses a command";
    case TrackerTrouble::tool_absent:
      return "a wired tool is not in its port";
    case TrackerTrouble::bad_answer:
      return "the tracker answers what was not asked";
    case TrackerTrouble::silent:
      return "the tracker has fallen silent";
    case TrackerTrouble::bad_crc:
      return "replies of the tracker arrive damaged";
    case TrackerTrouble::frame_stuck:
      return "the tracker repeats one frame";
    case TrackerTrouble::device_reset:
      return "the tracker has restarted";
    case TrackerTrouble::disconnected:
      return "the tracker is disconnected";
  }
  return "unknown trouble";
}

}  // namespace orcart
