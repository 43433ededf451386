// The way of the data at worst-case stage times under the simulated clock: the shipping pedal, camera and
// match stages, doubles where a GPU would be, and every step's outcome published only when its time is over.
#pragma once

#include <memory>
#include <vector>

#include "firmware-host/app/topology.hpp"
#include "realtime/kernel/simulated_runner.hpp"
#include "realtime/sync/refusal.hpp"

namespace orcart::testing {

/// Which stage times: the p99.9 of each row, or its hard bound.
enum class Times : std::uint8_t { p999, bound };

struct ScriptedSetup {
  RenderClass render_class = RenderClass::gpu;
  Times times = Times::bound;
  double camera_hz = 30, tracker_hz = 60, panel_hz = 60;
  Nanos exposure = 8ms, readout = 6ms;
  Nanos camera_phase{};    ///< first exposure's start, from the start
  Nanos tracker_phase{};   ///< first measurement
  Nanos tracker_delay{};   ///< from a measurement to its sample being handed over
  Nanos vblank_phase{};    ///< first vblank
  Nanos press_at = 200ms;  ///< the pedal's edge
  Nanos run_for = 700ms;
};

/// Everything counted from the start.
struct ShownFrame {
  std::uint32_t sequence = 0;
  Nanos dequeued{}, submitted{}, scan_out{};
};
struct ScriptedOutcome {
  std::vector<ShownFrame> shown;
  bool painted = false, failed = false;
  Refusal refusal = Refusal::none;
  std::uint32_t painted_sequence = 0;
  Nanos mid_exposure{};              ///< of the painted frame
  Nanos matched{};                   ///< when its pose bracket was in hand
  Nanos acknowledged{}, on_panel{};  ///< scan-outs
  std::uint64_t render_slips = 0, mapping_slips = 0, drops = 0;
};

ScriptedOutcome run_scripted(const ScriptedSetup& setup);

}  // namespace orcart::testing
