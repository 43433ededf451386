// One thread and what runs on it: the same description drives a real thread and its simulated twin.
#pragma once

#include <span>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/kernel/budget.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/kernel/thread_spec.hpp"
#include "realtime/kernel/trace_ring.hpp"
#include "realtime/kernel/wake_source.hpp"

namespace orcart {

/// Everything is lent and outlives the runner. A turn runs all stages in order.
struct ThreadPlan {
  ThreadSpec spec;
  std::vector<Stage*> stages;
  WakeSource* wake = nullptr;           ///< none: the thread is woken by its rate alone
  std::vector<StageLedger*> ledgers{};  ///< one for each stage, in order; or empty: nothing is kept
  TraceRing* trace = nullptr;           ///< none: nothing is traced
  /// SimulatedRunner alone: for each stage, how long a step that worked keeps the thread busy; or empty: no
  /// time. Read after the step, so a stage may vary its own.
  std::span<const Nanos> virtual_costs{};
};

/// Whether the plan can run; the error names the thread, the value and what would be accepted.
Result<void> check(const ThreadPlan& plan);

}  // namespace orcart
