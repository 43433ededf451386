// What the script says, delivered when the clock has reached it.
#include "board/sim/simulated_encoder.hpp"

#include <cmath>
#include <numbers>

namespace orcart {

EncoderScript encoder_script(const SimulatedWorld& world, double counts_per_turn,
                             const EncoderFaults& faults) {
  const Instant start = world.start();
  const auto instant = [&](Nanos at) { return at < 0ns ? Instant::max() : start + at; };
  EncoderScript script{.gone_at = instant(faults.gone_at),
                       .back_at = instant(faults.back_at),
                       .lost_at = instant(faults.lost_at)};
  std::int64_t counts = 0;
  for (Instant at = start; at <= world.end(); at += 1ms) {
    const double turned_rad =
        world.turn_rad(at) - world.turn_rad(start) + (at >= instant(faults.slip_at) ? faults.slip_rad : 0);
    const auto now =
        static_cast<std::int64_t>(std::floor(turned_rad / (2 * std::numbers::pi) * counts_per_turn + 0.5));
    if (now != counts) script.steps.push_back({.at = at, .counts = now});
    counts = now;
  }
  return script;
}

EncoderReading SimulatedEncoder::begin_run(Instant at) noexcept {
  run_from_ = stands_at_;
  return {.at = at, .counts = 0, .run = ++run_};
}

Result<EncoderReading, PortFault> SimulatedEncoder::take_reading() noexcept {
  const Instant now = clock_.now();
  if (run_ == 0) return begin_run(began_);
  const auto pass_until = [&](Instant until) {  // steps that nobody sees; bound: the script
    for (; next_ < script_.steps.size() && script_.steps[next_].at < until; ++next_)
      stands_at_ = script_.steps[next_].counts;
  };
  if (now >= script_.gone_at) {
    pass_until(std::min(now, script_.back_at));
    if (now < script_.back_at) return tl::unexpected(PortFault::disconnected);
    const Instant back = script_.back_at;
    script_.gone_at = script_.back_at = Instant::max();
    return begin_run(back);
  }
  if (now >= script_.lost_at && !lost_) {
    pass_until(script_.lost_at);
    lost_ = true;
    return begin_run(script_.lost_at);
  }
  if (next_ == script_.steps.size() || script_.steps[next_].at > now)
    return tl::unexpected(PortFault::nothing_yet);
  const EncoderStep& step = script_.steps[next_++];
  stands_at_ = step.counts;
  return EncoderReading{.at = step.at, .counts = step.counts - run_from_, .run = run_};
}

}  // namespace orcart
