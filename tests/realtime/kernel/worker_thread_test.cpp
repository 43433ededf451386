// A real thread on a simulated clock: its turns are exact too, the same as its twin's, and it asks nothing of
// the heap.
#include "realtime/kernel/worker_thread.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <semaphore>
#include <vector>

#include <gtest/gtest.h>

#include "realtime/kernel/simulated_runner.hpp"
#include "tests/realtime/kernel/scripted_stage.hpp"
#include "tests/support/allocation_guard.hpp"

namespace orcart {
namespace {

using testing::ScriptedStage;

/// Let a thread take this many steps, then ask it to stop; it may take more.
constexpr std::size_t kSteps = 50;

TEST(WorkerThread, StepsAtTheSameInstantsAsItsSimulatedTwin) {
  SimulatedClock real_clock;  // the worker alone looks at it, and its sleep moves it
  SimulatedClock twin_clock;
  const auto overrun = [](SimulatedClock& clock, std::size_t step) {
    clock.advance_by(step % 7 == 3 ? Nanos{35ms} : Nanos{1ms});
  };
  std::binary_semaphore enough{0};
  ScriptedStage stage("s", [&](std::size_t step) {
    overrun(real_clock, step);
    if (step == kSteps) enough.release();
  });
  ScriptedStage twin_stage("s", [&](std::size_t step) { overrun(twin_clock, step); });
  const ThreadSpec spec{.name = "twin", .rate_hz = 100};

  WorkerThread worker({.spec = spec, .stages = {&stage}}, real_clock);
  ASSERT_TRUE(worker.start().has_value());
  enough.acquire();
  worker.stop();
  SimulatedRunner runner({{.spec = spec, .stages = {&twin_stage}}}, twin_clock);
  runner.run_until(twin_clock.now() + 10s);

  ASSERT_GT(stage.instants().size(), kSteps);
  ASSERT_GT(twin_stage.instants().size(), kSteps);
  EXPECT_TRUE(
      std::equal(stage.instants().begin(), stage.instants().begin() + kSteps, twin_stage.instants().begin()));
}

TEST(WorkerThread, FillsItsLedgersAndItsTrace) {
  SimulatedClock clock;
  std::binary_semaphore enough{0};
  ScriptedStage stage("s", [&](std::size_t step) {
    clock.advance_by(step == 5 ? Nanos{25ms} : Nanos{2ms});
    if (step == kSteps) enough.release();
  });
  StageLedger ledger("s", {.p999 = 3ms, .bound = 20ms});
  TraceRing trace(1023);
  WorkerThread worker(
      {.spec = {.name = "ledger", .rate_hz = 100}, .stages = {&stage}, .ledgers = {&ledger}, .trace = &trace},
      clock);
  ASSERT_TRUE(worker.start().has_value());
  enough.acquire();
  worker.stop();
  EXPECT_GT(ledger.wall().count(), kSteps);
  EXPECT_EQ(ledger.over_bound(), 1u);
  EXPECT_EQ(worker.ledger().slips, 1u);
  EXPECT_EQ(worker.ledger().skipped, 2u);
  EXPECT_EQ(worker.ledger().turns, worker.ledger().lateness.count());
  EXPECT_GE(trace.written(), 2 * kSteps);
}

TEST(WorkerThread, AllocatesAndLocksNothingBetweenItsSteps) {
  if (!testing::kAllocationGuardWorks) GTEST_SKIP() << "sanitizers bring a malloc of their own";
  SimulatedClock clock;
  std::binary_semaphore enough{0};
  std::optional<testing::NoAllocationScope> scope;
  testing::HeapAndLockCounts counts{.allocations = 99};
  ScriptedStage stage("s", [&](std::size_t step) {
    if (step == 2) scope.emplace();
    if (step != kSteps) return;
    counts = scope->counts();
    scope.reset();
    enough.release();
  });
  StageLedger ledger("s");
  TraceRing trace(63);
  WorkerThread worker(
      {.spec = {.name = "heap", .rate_hz = 1000}, .stages = {&stage}, .ledgers = {&ledger}, .trace = &trace},
      clock);
  ASSERT_TRUE(worker.start().has_value());
  enough.acquire();
  worker.stop();
  EXPECT_EQ(counts.allocations, 0u);
  EXPECT_EQ(counts.frees, 0u);
  EXPECT_EQ(counts.locks, 0u);
}

TEST(WorkerThread, RunsOnTheWallClockAndMeasuresItsLateness) {
  RealClock clock;
  std::counting_semaphore<> steps{0};
  ScriptedStage stage("s", [&](std::size_t) { steps.release(); });
  WorkerThread worker({.spec = {.name = "wall", .rate_hz = 1000}, .stages = {&stage}}, clock);
  const Instant before = clock.now();
  ASSERT_TRUE(worker.start().has_value());
  for (int i = 0; i < 10; ++i) steps.acquire();
  EXPECT_GE(clock.now() - before,
            Nanos{9ms});  // ten turns span nine periods or more; later is the machine's affair
  worker.stop();
  EXPECT_GE(worker.ledger().lateness.count(), 10u);
}

class Bell final : public WakeSource {
 public:
  void ring() { bell_.release(); }
  void wait(Instant deadline) noexcept override {
    const auto left = deadline - clock_.now();
    if (left > Nanos{0}) (void)bell_.try_acquire_for(left);
  }

 private:
  RealClock clock_;
  std::counting_semaphore<> bell_{0};
};

TEST(WorkerThread, IsWokenByInputLongBeforeItsTimeout) {
  RealClock clock;
  Bell bell;
  std::counting_semaphore<> steps{0};
  ScriptedStage stage("s", [&](std::size_t) { steps.release(); });
  WorkerThread worker({.spec = {.name = "event", .event_timeout = 1h}, .stages = {&stage}, .wake = &bell},
                      clock);
  ASSERT_TRUE(worker.start().has_value());
  for (int i = 0; i < 5; ++i) {
    bell.ring();
    steps.acquire();
  }
  bell.ring();  // with its timeout of an hour it would not see stop() otherwise
  worker.stop();
  EXPECT_EQ(worker.ledger().lateness.count(), 0u);
}

TEST(WorkerThread, StopsWithinItsTimeoutWithoutInput) {
  RealClock clock;
  Bell bell;
  WorkerThread worker({.spec = {.name = "quiet", .event_timeout = 1ms}, .stages = {}, .wake = &bell}, clock);
  ASSERT_TRUE(worker.start().has_value());
  worker.stop();
  EXPECT_FALSE(worker.running());
}

TEST(WorkerThread, ReportsWhatItWasGranted) {
  RealClock clock;
  WorkerThread worker({.spec = {.name = "rights", .rate_hz = 1000, .fifo_priority = 10}, .stages = {}},
                      clock);
  ASSERT_TRUE(worker.start().has_value());
  EXPECT_TRUE(worker.rights().stack_prefaulted);
  EXPECT_EQ(worker.rights().degraded(), !worker.rights().fifo);
  worker.stop();
}

TEST(WorkerThread, RefusesAPlanThatCannotRun) {
  RealClock clock;
  WorkerThread worker({.spec = {.name = "idle"}, .stages = {}}, clock);
  const Result<void> started = worker.start();
  ASSERT_FALSE(started.has_value());
  EXPECT_NE(started.error().message.find("'idle'"), std::string::npos);
  EXPECT_FALSE(worker.running());
}

TEST(WorkerThread, RefusesToStartTwice) {
  RealClock clock;
  WorkerThread worker({.spec = {.name = "once", .rate_hz = 1000}, .stages = {}}, clock);
  ASSERT_TRUE(worker.start().has_value());
  EXPECT_FALSE(worker.start().has_value());
}

}  // namespace
}  // namespace orcart
