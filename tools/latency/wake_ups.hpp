// How late a sleeping thread wakes: ours beside a plain loop as cyclictest's, round by round, and the plain
// one beside itself.
#pragma once

#include <functional>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/kernel/histogram.hpp"
#include "realtime/kernel/thread_spec.hpp"

namespace orcart {

struct WakeUpWish {
  ThreadSpec spec;             ///< priority, processor and stack of both loops
  Nanos period = 500us;        ///< of both loops
  std::size_t rounds = 20;     ///< each: plain, ours, plain again, in turning order
  std::size_t samples = 1000;  ///< a loop and round, the first and last 10 left out
};

/// Of one kind of loop against the plain one, in one round.
struct WakeUpRatios {
  double p50 = 0, p99 = 0;
};

struct WakeUps {
  ThreadSpec spec;
  std::size_t samples_a_round = 0;
  HistogramSnapshot plain, ours;     ///< over all rounds; plain: the first of the two
  std::vector<WakeUpRatios> ratios;  ///< ours to plain, a round each
  std::vector<WakeUpRatios> noise;   ///< plain to plain
};

/// The middle one of the rounds, for each percentile by itself. A round's p99 is no figure to quote; the
/// median of 20 rounds' ratios is.
WakeUpRatios median_of(const std::vector<WakeUpRatios>& rounds);

/// Takes 3 * rounds * samples * period. `tick`, if any, is told the share that is done.
Result<WakeUps> measure_wake_ups(const WakeUpWish& wish, const std::function<void(double)>& tick = {});

}  // namespace orcart
