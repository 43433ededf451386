// The line is drained before time is let go on, so that no edge is judged late.
#include "firmware-host/stages/pedal_stage.hpp"

namespace orcart {

StepReport PedalStage::step(Instant now) noexcept {
  StepReport report;
  for (int i = 0; i < kMostEdges; ++i) {
    const auto edge = lines_.take_edge();
    fault_.set(edge ? PortFault::nothing_yet : edge.error());
    if (!edge) break;
    gestures_.edge(*edge);
    ++report.items;
  }
  gestures_.advance(now);
  while (const auto event = gestures_.next()) {  // bound: the gestures' own 16 places
    (void)lanes_.pedal.try_push(*event);
    if (event->kind == PedalEventKind::capture) (void)lines_.pulse_trigger(now, kTriggerWidth);
  }
  lanes_.pedal_news.post({.connected = fault_.get() != PortFault::disconnected});
  report.worked = report.items > 0;
  return report;
}

}  // namespace orcart
