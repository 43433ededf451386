// The simulated turn encoder: steps at their instants, and what a real one may do wrong.
#pragma once

#include <cstdint>
#include <vector>

#include "board/ports/turn_encoder.hpp"
#include "board/sim/simulated_world.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// From `at` on the encoder stands at `counts`, counted from where it stood at its making.
struct EncoderStep {
  Instant at{};
  std::int64_t counts = 0;
};

/// What happens to it. Faults: unplugged in [gone_at, back_at); at `lost_at` the kernel's queue overflows.
struct EncoderScript {
  std::vector<EncoderStep> steps{};  ///< in the order of time
  Instant gone_at = Instant::max(), back_at = Instant::max();
  Instant lost_at = Instant::max();
};

/// What goes wrong with an encoder in a procedure; instants from its start, below 0: never.
struct EncoderFaults {
  Nanos gone_at{-1}, back_at{-1};
  Nanos lost_at{-1};
  Nanos slip_at{-1};  ///< what carries the encoder slips about the shaft: it turns, the light post does not,
  double slip_rad = 0;  ///< by so much
};

/// What an encoder on the light post tells while a procedure lasts, to the millisecond; counts rise with the
/// turn.
EncoderScript encoder_script(const SimulatedWorld& world, double counts_per_turn,
                             const EncoderFaults& faults = {});

/// A relative one: each run begins at 0. Memory is taken in the constructor. One thread calls.
class SimulatedEncoder final : public TurnEncoder {
 public:
  SimulatedEncoder(const Clock& clock, EncoderScript script)
      : clock_(clock), script_(std::move(script)), began_(clock.now()) {}

  Result<EncoderReading, PortFault> take_reading() noexcept override;

 private:
  EncoderReading begin_run(Instant at) noexcept;

  const Clock& clock_;
  EncoderScript script_;
  Instant began_;
  std::size_t next_ = 0;
  std::int64_t stands_at_ = 0, run_from_ = 0;
  std::uint32_t run_ = 0;
  bool lost_ = false;
};

}  // namespace orcart
