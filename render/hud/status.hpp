// What the panel says besides the picture: plain data, filled in by the panel stage, drawn by the screen.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace orcart {

/// By source stamps alone; old data is never shown as live.
enum class Freshness : std::uint8_t { lost, stale, live };

/// One line of fixed length, so that it can be filled in on a real-time thread. Not longer: cut.
struct Notice {
  std::array<char, 96> text{};  ///< UTF-8, zero-terminated
  enum class Level : std::uint8_t { none, info, warning, alarm } level = Level::none;
  bool operator==(const Notice&) const = default;
};

struct Status {
  Freshness video = Freshness::lost;
  Freshness tracker = Freshness::lost;
  bool tool_seen = false;
  bool reference_seen = false;
  bool simulated = true;
  bool degraded = false;  ///< the machine lacks rights that the threads want; the run's report names them
  bool software_rendering = false;
  bool painting_blocked = false;      ///< the passport forbids it: see notice
  bool capture_acknowledged = false;  ///< a press arrived; its picture is not painted yet
  bool streaming = false;
  std::uint32_t captures = 0;
  std::uint32_t late_frames = 0;
  std::uint32_t budget_misses = 0;  ///< steps over their hard bound, of all stages
  std::string_view missed_stage{};  ///< the newest one's; a name that outlives the panel
  float coverage = 0;               ///< 0..1
  float latency_ms = 0;             ///< dequeue to scan-out, the longest of the last half second
  float rendered_hz = 0;
  Notice notice;  ///< the one thing a person should read now

  bool operator==(const Status&) const = default;
};

}  // namespace orcart
