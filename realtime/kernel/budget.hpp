// A stage's promise in time, and the ledger that holds it to it.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>

#include "realtime/base/instant.hpp"
#include "realtime/kernel/histogram.hpp"
#include "realtime/kernel/stage.hpp"

namespace orcart {

/// p999: 99.9 % of the steps take no longer. bound: none takes longer. Nanos::max() promises nothing.
struct Budget {
  Nanos p999 = Nanos::max();
  Nanos bound = Nanos::max();
};

/// One step's time: `wall` is what the clock says, `cpu` what the thread itself used; a long wall with a
/// short cpu is the machine's fault, not the step's.
struct StepTiming {
  Instant at;  ///< when it began
  Nanos wall{0};
  Nanos cpu{0};
};

/// How a stage's samples stand against its budget.
struct BudgetVerdict {
  bool within_bound = true;
  std::optional<double>
      judged_quantile;          ///< the highest the samples support, 0.999 at most; nothing: too few
  Nanos at_quantile{0};         ///< its value; compared with Budget::p999
  bool within_quantile = true;  ///< true where nothing could be judged: see judged_quantile
};

BudgetVerdict judge(const Budget& budget, const HistogramSnapshot& wall) noexcept;

/// One writer thread records; any thread reads. Only steps that worked are samples.
class StageLedger {
 public:
  explicit StageLedger(std::string_view name, Budget budget = {}) noexcept : name_(name), budget_(budget) {}

  /// Writer. A report with worked == false leaves no trace.
  void record(const StepTiming& timing, const StepReport& report) noexcept;

  std::string_view name() const noexcept { return name_; }  ///< borrowed from the constructor's caller
  const Budget& budget() const noexcept { return budget_; }
  const Histogram& wall() const noexcept { return wall_; }
  const Histogram& cpu() const noexcept { return cpu_; }
  // Counts, each alone: relaxed, without partners.
  std::uint64_t over_bound() const noexcept { return over_bound_.load(std::memory_order_relaxed); }
  std::uint64_t over_p999() const noexcept { return over_p999_.load(std::memory_order_relaxed); }
  std::uint64_t carried() const noexcept { return carried_.load(std::memory_order_relaxed); }
  std::uint64_t items() const noexcept { return items_.load(std::memory_order_relaxed); }
  /// When the last step over the bound began; nothing where none was.
  std::optional<Instant> last_miss() const noexcept;

 private:
  static constexpr std::int64_t kNever = INT64_MIN;

  std::string_view name_;
  Budget budget_;
  Histogram wall_;
  Histogram cpu_;
  std::atomic<std::uint64_t> over_bound_{0};
  std::atomic<std::uint64_t> over_p999_{0};
  std::atomic<std::uint64_t> carried_{0};
  std::atomic<std::uint64_t> items_{0};
  std::atomic<std::int64_t> last_miss_ns_{kNever};
};

}  // namespace orcart
