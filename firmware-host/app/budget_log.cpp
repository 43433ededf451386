// Counts are compared with what was told before.
#include "firmware-host/app/budget_log.hpp"

#include <algorithm>
#include <cstdio>

namespace orcart {

std::vector<std::string> BudgetLog::news(const std::array<StageLedger, kStageCount>& ledgers, Instant now) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    const StageLedger& ledger = ledgers[i];
    const std::uint64_t missed = ledger.over_bound();
    if (missed == told_[i] || now < next_[i]) continue;
    HistogramSnapshot wall, cpu;
    ledger.wall().read(wall);
    ledger.cpu().read(cpu);
    char line[320];
    std::snprintf(
        line, sizeof line,
        "over budget: stage \"%.*s\" (thread %.*s) took longer than its bound of %g ms %llu times, %llu of "
        "them new; longest %.3f ms, of which the thread itself ran at most %.3f ms",
        static_cast<int>(ledger.name().size()), ledger.name().data(),
        static_cast<int>(spec_of(kStages[i].thread).name.size()), spec_of(kStages[i].thread).name.data(),
        milliseconds(ledger.budget().bound), static_cast<unsigned long long>(missed),
        static_cast<unsigned long long>(missed - told_[i]), milliseconds(wall.max()),
        milliseconds(cpu.max()));
    lines.emplace_back(line);
    told_[i] = missed;
    pause_[i] = std::clamp(2 * pause_[i], kFirstPause, kLongestPause);
    next_[i] = now + pause_[i];
  }
  return lines;
}

}  // namespace orcart
