// Picks the thread that is due first, moves the clock there and runs one step of it.
#include "realtime/kernel/simulated_runner.hpp"

#include <algorithm>
#include <utility>

namespace orcart {

struct SimulatedRunner::Task {
  Task(ThreadPlan given, Instant start) : plan(std::move(given)), loop(plan), free_at(start) {
    loop.begin(start);
  }

  /// When it goes on: with its next stage, or awake from sleep.
  Instant next() const noexcept {
    if (in_turn) return free_at;
    const Instant due = loop.wake_by(free_at);
    const bool listens = plan.wake != nullptr && turns_at_once < kMaxTurnsAtOnce;
    return std::max(free_at, listens ? std::min(due, plan.wake->next_event()) : due);
  }

  ThreadPlan plan;
  ThreadLoop loop;
  Instant free_at;  ///< its last step is over
  std::size_t next_stage = 0;
  bool in_turn = false;
  Instant last_woken = Instant::min();
  int turns_at_once = 0;
};

SimulatedRunner::SimulatedRunner(std::vector<ThreadPlan> plans, SimulatedClock& clock) : clock_(clock) {
  for (ThreadPlan& plan : plans) {
    tasks_.push_back(std::make_unique<Task>(std::move(plan), clock.now()));
    by_priority_.push_back(tasks_.back().get());
  }
  std::ranges::stable_sort(by_priority_, std::ranges::greater{},
                           [](const Task* task) { return task->plan.spec.fifo_priority; });
}

SimulatedRunner::~SimulatedRunner() = default;

void SimulatedRunner::run_until(Instant end) noexcept {
  for (Task* task = next_task(); task != nullptr && task->next() <= end; task = next_task()) {
    clock_.advance_to(task->next());
    advance(*task);
  }
  clock_.advance_to(end);
}

Instant SimulatedRunner::next_due() const noexcept {
  const Task* const task = next_task();
  return task != nullptr ? task->next() : Instant::max();
}

const ThreadLedger& SimulatedRunner::ledger(std::size_t plan) const noexcept {
  return tasks_[plan]->loop.ledger();
}

SimulatedRunner::Task* SimulatedRunner::next_task() const noexcept {
  // min_element keeps the first of equals: by priority, then by the order of the plans.
  const auto first =
      std::ranges::min_element(by_priority_, {}, [](const Task* task) { return task->next(); });
  return first != by_priority_.end() ? *first : nullptr;
}

void SimulatedRunner::advance(Task& task) noexcept {
  if (!task.in_turn) wake(task);
  if (task.next_stage < task.plan.stages.size()) step(task);
  if (task.next_stage < task.plan.stages.size()) return;
  task.loop.turn_over(task.free_at);
  task.in_turn = false;
}

void SimulatedRunner::wake(Task& task) noexcept {
  const Instant now = clock_.now();
  const Instant due = task.loop.wake_by(task.free_at);
  if (task.plan.wake != nullptr) task.plan.wake->wait(now);
  task.turns_at_once = now == task.last_woken ? task.turns_at_once + 1 : 0;
  task.last_woken = now;
  task.loop.woke(now, due);
  task.free_at = now;
  task.next_stage = 0;
  task.in_turn = true;
}

void SimulatedRunner::step(Task& task) noexcept {
  const std::size_t stage = task.next_stage++;
  const Instant began = clock_.now();
  const StepReport report = task.plan.stages[stage]->step(began);
  const Nanos cost =
      report.worked && !task.plan.virtual_costs.empty() ? task.plan.virtual_costs[stage] : Nanos{0};
  const Nanos took = std::max(cost, clock_.now() - began);
  task.loop.stepped(stage, {.at = began, .wall = took, .cpu = took}, report);
  task.free_at = began + took;
  ++steps_;
}

}  // namespace orcart
