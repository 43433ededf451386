// The plain loop is sleep, read the clock, keep the difference; ours is a WorkerThread with a stage that does
// nothing.
#include "tools/latency/wake_ups.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <thread>

#include "realtime/kernel/worker_thread.hpp"

namespace orcart {
namespace {

constexpr std::size_t kDropped = 10;

class Idle final : public Stage {
 public:
  std::string_view name() const noexcept override { return "idle"; }
  StepReport step(Instant) noexcept override {
    steps_.fetch_add(1, std::memory_order_relaxed);  // a count alone, no partner
    return {};
  }
  std::size_t steps() const { return steps_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::size_t> steps_{0};
};

void drop_ends(std::vector<Nanos>& lateness) {
  lateness.erase(lateness.end() - kDropped, lateness.end());
  lateness.erase(lateness.begin(), lateness.begin() + kDropped);
}

std::vector<Nanos> plain_loop(const WakeUpWish& wish) {
  const std::size_t count = wish.samples + 2 * kDropped;
  std::vector<Nanos> lateness(count);
  std::thread thread([&] {
    (void)acquire_thread_rights(wish.spec);
    RealClock clock;
    Instant due = clock.now();
    for (Nanos& late : lateness) {
      due += wish.period;
      clock.sleep_until(due);
      const Instant now = clock.now();
      late = now - due;
      while (due + wish.period <= now) due += wish.period;  // what was slept through is skipped, as ours does
    }
  });
  thread.join();
  drop_ends(lateness);
  return lateness;
}

Result<std::vector<Nanos>> our_loop(const WakeUpWish& wish) {
  const std::size_t count = wish.samples + 2 * kDropped;
  RealClock clock;
  Idle stage;
  TraceRing trace(4 * count);
  ThreadPlan plan{.spec = wish.spec, .stages = {&stage}, .trace = &trace};
  plan.spec.rate_hz = 1 / seconds(wish.period);
  WorkerThread worker(plan, clock);
  if (auto started = worker.start(); !started) return tl::unexpected(started.error());
  while (stage.steps() < count) clock.sleep_until(clock.now() + 10ms);
  worker.stop();
  std::vector<Nanos> lateness;
  for (const TraceEvent& event : trace.snapshot())
    if (event.kind == TraceKind::wake && lateness.size() < count) lateness.emplace_back(event.value);
  drop_ends(lateness);
  return lateness;
}

double quantile(std::vector<Nanos>& lateness, double q) {
  const auto rank = static_cast<std::ptrdiff_t>(q * static_cast<double>(lateness.size() - 1));
  std::nth_element(lateness.begin(), lateness.begin() + rank, lateness.end());
  return static_cast<double>(std::max<std::int64_t>(1, lateness[static_cast<std::size_t>(rank)].count()));
}

WakeUpRatios ratio(std::vector<Nanos> of, std::vector<Nanos> to) {
  return {.p50 = quantile(of, 0.5) / quantile(to, 0.5), .p99 = quantile(of, 0.99) / quantile(to, 0.99)};
}

void record(Histogram& histogram, std::span<const Nanos> lateness) {
  for (const Nanos late : lateness) histogram.record(late);
}

}  // namespace

WakeUpRatios median_of(const std::vector<WakeUpRatios>& rounds) {
  if (rounds.empty()) return {};
  std::vector<double> p50, p99;
  for (const WakeUpRatios& round : rounds) {
    p50.push_back(round.p50);
    p99.push_back(round.p99);
  }
  const auto middle = static_cast<std::ptrdiff_t>(rounds.size() / 2);
  std::nth_element(p50.begin(), p50.begin() + middle, p50.end());
  std::nth_element(p99.begin(), p99.begin() + middle, p99.end());
  return {.p50 = p50[static_cast<std::size_t>(middle)], .p99 = p99[static_cast<std::size_t>(middle)]};
}

Result<WakeUps> measure_wake_ups(const WakeUpWish& wish, const std::function<void(double)>& tick) {
  WakeUps result{.spec = wish.spec, .samples_a_round = wish.samples, .plain = {}, .ours = {}};
  Histogram plain_all, ours_all;
  for (std::size_t round = 0; round < wish.rounds; ++round) {
    if (tick) tick(static_cast<double>(round) / static_cast<double>(wish.rounds));
    std::array<std::vector<Nanos>, 3> loops;  // plain, ours, plain again; none is always the first
    for (std::size_t i = 0; i < loops.size(); ++i) {
      const std::size_t which = (i + round) % loops.size();
      if (which != 1) {
        loops[which] = plain_loop(wish);
        continue;
      }
      auto ours = our_loop(wish);
      if (!ours) return tl::unexpected(ours.error());
      loops[which] = std::move(*ours);
    }
    record(plain_all, loops[0]);
    record(ours_all, loops[1]);
    result.ratios.push_back(ratio(loops[1], loops[0]));
    result.noise.push_back(ratio(loops[2], loops[0]));
  }
  plain_all.read(result.plain);
  ours_all.read(result.ours);
  return result;
}

}  // namespace orcart
