// The real pedal line and trigger line: edges with kernel stamps, pulses of a stated width, a chip that goes
// and comes back.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "board/linux/pedal/requested_lines.hpp"
#include "board/ports/gpio_lines.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// One thread. A chip that is gone is looked for again in wait(), at most every 0.2 s. A pulse ends in the
/// first wait() or take_edge() after its width: in time where the pedal's thread waits.
class GpioPedal final : public GpioLines {
 public:
  static Result<std::unique_ptr<GpioPedal>> open(const GpioWish& wish, Clock& clock,
                                                 LineKeeper& keeper = kernel_lines());
  /// Lowers a raised trigger line.
  ~GpioPedal() override;

  void wait(Instant deadline) noexcept override;
  Result<PedalEdge, PortFault> take_edge() noexcept override;
  /// A pulse that is still on is prolonged.
  Result<void, PortFault> pulse_trigger(Instant now, Nanos width) noexcept override;

  /// How often the level itself is read: a chip that went silently, an edge that was lost.
  static constexpr Nanos kCheck = 100ms;
  static constexpr Nanos kRetry = 200ms;

 private:
  GpioPedal(const GpioWish& wish, Clock& clock, LineKeeper& keeper)
      : wish_(wish), clock_(clock), keeper_(keeper) {}
  void adopt(std::unique_ptr<RequestedLines> lines) noexcept;
  void lose_chip() noexcept;
  void look_for_chip() noexcept;
  void end_pulse() noexcept;
  void check_level() noexcept;

  GpioWish wish_;
  Clock& clock_;
  LineKeeper& keeper_;
  std::unique_ptr<RequestedLines> lines_;  ///< null while the chip is gone
  EdgeLedger ledger_;
  std::optional<PedalEdge> missed_;  ///< what the level tells though no edge came
  int disagreements_ = 0;            ///< checks in a row in which level and edges differ
  Instant check_at_{}, retry_at_{};
  std::optional<Instant> pulse_end_;
};

}  // namespace orcart
