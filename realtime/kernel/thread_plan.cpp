// Refuses a thread that could not run, before it is started.
#include "realtime/kernel/thread_plan.hpp"

#include <algorithm>
#include <string>

namespace orcart {
namespace {

constexpr std::size_t kSmallestStack = 64 * 1024;

std::string fault_in(const ThreadPlan& plan) {
  const ThreadSpec& spec = plan.spec;
  if (spec.name.empty()) return "has no name; each thread wants one";
  if (!(spec.rate_hz >= 0) || spec.rate_hz > 1e6) {
    return "has rate_hz " + std::to_string(spec.rate_hz) + "; 0 to 1,000,000 is accepted";
  }
  if (spec.rate_hz == 0 && plan.wake == nullptr)
    return "has neither a rate nor a wake source; it would never run";
  if (plan.wake != nullptr && spec.event_timeout <= Nanos{0})
    return "has no event_timeout; over 0 ns is accepted";
  if (spec.fifo_priority < 0 || spec.fifo_priority > 99) {
    return "has fifo_priority " + std::to_string(spec.fifo_priority) + "; 0 (none) to 99 is accepted";
  }
  if (spec.stack_bytes < kSmallestStack) {
    return "has stack_bytes " + std::to_string(spec.stack_bytes) + "; 65536 or more is accepted";
  }
  if (std::ranges::count(plan.stages, nullptr) > 0) return "has a null stage; each entry must point to one";
  const std::size_t stages = plan.stages.size();
  if (!plan.ledgers.empty() && plan.ledgers.size() != stages) {
    return "has " + std::to_string(plan.ledgers.size()) + " ledgers for " + std::to_string(stages) +
           " stages; one for each or none is accepted";
  }
  if (!plan.virtual_costs.empty() && plan.virtual_costs.size() != stages) {
    return "has " + std::to_string(plan.virtual_costs.size()) + " virtual costs for " +
           std::to_string(stages) + " stages; one for each or none is accepted";
  }
  return {};
}

}  // namespace

Result<void> check(const ThreadPlan& plan) {
  const std::string fault = fault_in(plan);
  if (fault.empty()) return {};
  return fail("thread '" + std::string(plan.spec.name) + "' " + fault);
}

}  // namespace orcart
