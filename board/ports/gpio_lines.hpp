// The pedal's seam: stamped edges in, a trigger pulse out.
#pragma once

#include <cstdint>

#include "board/ports/port_fault.hpp"
#include "realtime/base/result.hpp"
#include "realtime/kernel/wake_source.hpp"

namespace orcart {

enum class EdgeKind : std::uint8_t { pressed, released };

/// One edge of the pedal's line, polarity already applied.
struct PedalEdge {
  Instant at{};  ///< the kernel's stamp
  EdgeKind kind = EdgeKind::pressed;
  std::uint32_t sequence = 0;  ///< counted per line; a gap is a lost edge
};

/// One thread calls.
class GpioLines : public WakeSource {
 public:
  /// The oldest edge not yet taken; nothing_yet where there is none.
  virtual Result<PedalEdge, PortFault> take_edge() noexcept = 0;
  /// Raises the trigger line now and lowers it after `width`; returns at once.
  virtual Result<void, PortFault> pulse_trigger(Instant now, Nanos width) noexcept = 0;
};

}  // namespace orcart
