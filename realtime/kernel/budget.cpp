// Keeps a stage's ledger and judges it at the quantile its samples support.
#include "realtime/kernel/budget.hpp"

#include "realtime/kernel/one_writer.hpp"

namespace orcart {

BudgetVerdict judge(const Budget& budget, const HistogramSnapshot& wall) noexcept {
  BudgetVerdict verdict{.within_bound = wall.max() <= budget.bound,
                        .judged_quantile = highest_supported_quantile(wall.count())};
  if (verdict.judged_quantile) {
    verdict.at_quantile = wall.percentile(*verdict.judged_quantile).value_or(wall.max());
    verdict.within_quantile = verdict.at_quantile <= budget.p999;
  }
  return verdict;
}

void StageLedger::record(const StepTiming& timing, const StepReport& report) noexcept {
  if (!report.worked) return;
  wall_.record(timing.wall);
  cpu_.record(timing.cpu);
  add_alone(items_, report.items);
  if (report.carried) add_alone(carried_, 1);
  if (timing.wall > budget_.p999) add_alone(over_p999_, 1);
  if (timing.wall <= budget_.bound) return;
  add_alone(over_bound_, 1);
  last_miss_ns_.store(nanos_since_zero(timing.at), std::memory_order_relaxed);  // read alone, no partner
}

std::optional<Instant> StageLedger::last_miss() const noexcept {
  const std::int64_t ns = last_miss_ns_.load(std::memory_order_relaxed);  // read alone, no partner
  if (ns == kNever) return std::nullopt;
  return instant_from_nanos(ns);
}

}  // namespace orcart
