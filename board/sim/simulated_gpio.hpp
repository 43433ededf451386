// The simulated pedal line and trigger line: scheduled edges with contact bounce and lost edges; pulses are
// recorded.
#pragma once

#include <span>
#include <vector>

#include "board/ports/gpio_lines.hpp"
#include "board/sim/live_pedal.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// What the contacts do at every edge: pairs of chatter after it, each back and forth again after one
/// spacing.
struct ContactBounce {
  int pairs = 0;
  Nanos spacing = 700us;
};

/// What happens on the lines. Faults: `lost` edges leave a gap in the sequence; from `gone_at` the chip is
/// unplugged.
struct GpioScript {
  std::vector<PedalEdge> edges{};  ///< any order; their sequence numbers are not read
  ContactBounce bounce{};
  std::vector<std::uint32_t> lost{};  ///< sequence numbers (after bounce, from 1) the driver loses
  Instant gone_at = Instant::max();
};

/// One rise and fall of the trigger line.
struct TriggerPulse {
  Instant rise{};
  Nanos width{};
};

/// The edges of a script as the kernel would stamp and count them, in the order of time.
std::vector<PedalEdge> edges_on_the_line(const GpioScript& script);

/// Memory is taken in the constructor. One thread calls; `live`, where given, is fed by another.
class SimulatedGpio final : public GpioLines {
 public:
  SimulatedGpio(Clock& clock, const GpioScript& script, LivePedal* live = nullptr);

  void wait(Instant deadline) noexcept override;
  Instant next_event() const noexcept override;
  Result<PedalEdge, PortFault> take_edge() noexcept override;
  Result<void, PortFault> pulse_trigger(Instant now, Nanos width) noexcept override;

  /// The pulses so far, oldest first; the first 65,536 are kept.
  std::span<const TriggerPulse> pulses() const noexcept { return pulses_; }

 private:
  Clock& clock_;
  std::vector<PedalEdge> edges_;
  std::size_t next_ = 0;
  std::uint32_t sequence_ = 0;  ///< of the newest edge taken
  Instant gone_at_;
  LivePedal* live_;
  std::vector<TriggerPulse> pulses_;
};

}  // namespace orcart
