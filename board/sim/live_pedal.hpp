// A pedal that a person presses while a simulation runs (a key of the preview window): edges from one thread
// to another.
#pragma once

#include "board/ports/gpio_lines.hpp"
#include "realtime/kernel/spsc_queue.hpp"

namespace orcart {

/// The window's thread pushes, the pedal's thread takes; neither waits. Edges beyond 64 waiting ones are
/// dropped.
class LivePedal {
 public:
  bool push(EdgeKind kind, Instant at) noexcept { return edges_.try_push({.at = at, .kind = kind}); }
  bool pop(PedalEdge& edge) noexcept { return edges_.try_pop(edge); }
  bool waiting() const noexcept { return edges_.size() > 0; }

 private:
  SpscQueue<PedalEdge> edges_{64};
};

}  // namespace orcart
