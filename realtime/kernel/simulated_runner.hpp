// The simulated twin of the threads: runs the same plans on one thread in the order of simulated time, the
// same way every time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/thread_loop.hpp"

namespace orcart {

/// Each simulated thread has a processor of its own. A step happens at the instant it begins; its virtual
/// cost (and whatever it moved the clock by) only keeps its thread busy. At one instant the higher
/// fifo_priority goes first, then the earlier plan. One thread; start it from the instant at which the clock
/// stands.
class SimulatedRunner {
 public:
  /// Plans must pass check(); what they lend and `clock` outlive this. Memory is taken here.
  SimulatedRunner(std::vector<ThreadPlan> plans, SimulatedClock& clock);
  ~SimulatedRunner();
  SimulatedRunner(const SimulatedRunner&) = delete;
  SimulatedRunner& operator=(const SimulatedRunner&) = delete;

  /// Runs every step that begins up to and at `end`, and leaves the clock there. Bounded by the periods and
  /// event_timeouts that fit in, and by kMaxTurnsAtOnce for a source that keeps saying "now".
  void run_until(Instant end) noexcept;

  /// The instant of the next step or wake-up; Instant::max() where there is no thread.
  Instant next_due() const noexcept;

  /// By the order of the plans.
  const ThreadLedger& ledger(std::size_t plan) const noexcept;
  std::uint64_t steps() const noexcept { return steps_; }

  /// Turns a thread may take at one instant before its WakeSource is passed over until its next wake_by.
  static constexpr int kMaxTurnsAtOnce = 1000;

 private:
  struct Task;

  Task* next_task() const noexcept;
  void advance(Task& task) noexcept;
  void wake(Task& task) noexcept;
  void step(Task& task) noexcept;

  SimulatedClock& clock_;
  std::vector<std::unique_ptr<Task>> tasks_;  ///< by the order of the plans
  std::vector<Task*> by_priority_;
  std::uint64_t steps_ = 0;
};

}  // namespace orcart
