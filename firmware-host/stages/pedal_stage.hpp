// Reads the pedal's edges and hands on what they mean; raises the trigger line at every press. Thread: pedal.
// Rate: when an edge comes. Budget: topology, row "pedal".
#pragma once

#include "board/ports/gpio_lines.hpp"
#include "firmware-host/pedal/pedal_gestures.hpp"
#include "firmware-host/stages/lanes.hpp"
#include "firmware-host/stages/watched_fault.hpp"
#include "realtime/kernel/stage.hpp"

namespace orcart {

class PedalStage final : public Stage {
 public:
  PedalStage(GpioLines& lines, const PedalSettings& settings, Lanes& lanes)
      : lines_(lines), gestures_(settings), lanes_(lanes) {}

  std::string_view name() const noexcept override { return "pedal"; }
  StepReport step(Instant now) noexcept override;

  /// nothing_yet while the pedal is there. Any thread.
  PortFault fault() const noexcept { return fault_.get(); }

 private:
  static constexpr int kMostEdges = 32;  ///< of one step; more are bounce, and wait for the next
  static constexpr Nanos kTriggerWidth = 10ms;

  GpioLines& lines_;
  PedalGestures gestures_;
  Lanes& lanes_;
  WatchedFault fault_;
};

}  // namespace orcart
