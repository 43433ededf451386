// The simulated twin: order, overruns and waking are exact and the same every time.
#include "realtime/kernel/simulated_runner.hpp"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/realtime/kernel/scripted_stage.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using testing::ScriptedStage;

/// Input at given instants; step() of a stage consumes it by calling take().
class ScriptedInput final : public WakeSource {
 public:
  explicit ScriptedInput(std::vector<Instant> events) : events_(std::move(events)) {}
  void wait(Instant) noexcept override {}
  Instant next_event() const noexcept override {
    return taken_ < events_.size() ? events_[taken_] : Instant::max();
  }
  void take() { ++taken_; }

 private:
  std::vector<Instant> events_;
  std::size_t taken_ = 0;
};

class SimulatedRunnerTest : public ::testing::Test {
 protected:
  Instant at(Nanos since_start) const { return start_ + since_start; }

  SimulatedClock clock_;
  const Instant start_ = clock_.now();
};

TEST_F(SimulatedRunnerTest, StepsAPeriodicThreadOnItsGrid) {
  ScriptedStage stage("a");
  SimulatedRunner runner({{.spec = {.name = "a", .rate_hz = 100}, .stages = {&stage}}}, clock_);
  runner.run_until(at(25ms));
  EXPECT_EQ(stage.instants(), (std::vector{at(0ms), at(10ms), at(20ms)}));
  EXPECT_EQ(clock_.now(), at(25ms));
  EXPECT_EQ(runner.next_due(), at(30ms));
}

TEST_F(SimulatedRunnerTest, RunsTheSameInOneGoAndInPieces) {
  ScriptedStage whole("a");
  ScriptedStage pieces("b");
  SimulatedClock other(start_);
  SimulatedRunner one({{.spec = {.name = "a", .rate_hz = 60}, .stages = {&whole}}}, clock_);
  SimulatedRunner many({{.spec = {.name = "b", .rate_hz = 60}, .stages = {&pieces}}}, other);
  one.run_until(at(1s));
  for (int i = 1; i <= 100; ++i) many.run_until(at(i * 10ms));
  EXPECT_EQ(whole.instants(), pieces.instants());
}

TEST_F(SimulatedRunnerTest, KeepsPhaseAndCountsExactlyAfterAnOverrunOfThreeAndAHalfPeriods) {
  std::array<Nanos, 1> cost{1ms};
  ScriptedStage stage("a", [&](std::size_t step) { cost[0] = step == 2 ? Nanos{35ms} : Nanos{1ms}; });
  StageLedger ledger("a", {.p999 = 2ms, .bound = 30ms});
  SimulatedRunner runner({{.spec = {.name = "a", .rate_hz = 100},
                           .stages = {&stage},
                           .ledgers = {&ledger},
                           .virtual_costs = cost}},
                         clock_);
  runner.run_until(at(75ms));
  EXPECT_EQ(stage.instants(), (std::vector{at(0ms), at(10ms), at(20ms), at(60ms), at(70ms)}));
  EXPECT_EQ(runner.ledger(0).slips, 1u);
  EXPECT_EQ(runner.ledger(0).skipped, 3u);
  EXPECT_EQ(runner.ledger(0).turns, 5u);
  EXPECT_EQ(ledger.over_bound(), 1u);
  EXPECT_EQ(ledger.last_miss(), at(20ms));
  EXPECT_EQ(ledger.wall().snapshot().max(), Nanos{35ms});
}

TEST_F(SimulatedRunnerTest, RunLateCatchesUpBackToBack) {
  std::array<Nanos, 1> cost{};
  ScriptedStage stage("a", [&](std::size_t step) { cost[0] = step == 0 ? Nanos{25ms} : Nanos{1ms}; });
  SimulatedRunner runner({{.spec = {.name = "a", .rate_hz = 100, .overrun = OverrunPolicy::run_late},
                           .stages = {&stage},
                           .virtual_costs = cost}},
                         clock_);
  runner.run_until(at(30ms));
  EXPECT_EQ(stage.instants(), (std::vector{at(0ms), at(25ms), at(26ms), at(30ms)}));
  EXPECT_EQ(runner.ledger(0).skipped, 0u);
  EXPECT_EQ(runner.ledger(0).lateness.snapshot().max(), Nanos{15ms});  // the turn of 10 ms began at 25 ms
}

TEST_F(SimulatedRunnerTest, StepsLaterStagesWhenTheEarlierOnesAreDone) {
  const std::array<Nanos, 2> costs{2ms, 3ms};
  ScriptedStage first("a");
  ScriptedStage second("b");
  SimulatedRunner runner(
      {{.spec = {.name = "t", .rate_hz = 100}, .stages = {&first, &second}, .virtual_costs = costs}}, clock_);
  runner.run_until(at(15ms));
  EXPECT_EQ(first.instants(), (std::vector{at(0ms), at(10ms)}));
  EXPECT_EQ(second.instants(), (std::vector{at(2ms), at(12ms)}));
}

TEST_F(SimulatedRunnerTest, LetsTheHigherPriorityGoFirstAtOneInstant) {
  std::string order;
  ScriptedStage low("l", [&](std::size_t) { order += 'l'; });
  ScriptedStage high("h", [&](std::size_t) { order += 'h'; });
  ScriptedStage same("s", [&](std::size_t) { order += 's'; });
  SimulatedRunner runner({{.spec = {.name = "l", .rate_hz = 100, .fifo_priority = 10}, .stages = {&low}},
                          {.spec = {.name = "h", .rate_hz = 100, .fifo_priority = 50}, .stages = {&high}},
                          {.spec = {.name = "s", .rate_hz = 100, .fifo_priority = 10}, .stages = {&same}}},
                         clock_);
  runner.run_until(at(10ms));
  EXPECT_EQ(order, "hlshls");
}

TEST_F(SimulatedRunnerTest, WakesAnEventDrivenThreadAtItsInputAndAtItsTimeout) {
  ScriptedInput input({at(3ms), at(4ms), at(40ms)});
  ScriptedStage stage("e", [&](std::size_t) {
    if (input.next_event() <= clock_.now()) input.take();
  });
  SimulatedRunner runner({{.spec = {.name = "e", .event_timeout = 20ms}, .stages = {&stage}, .wake = &input}},
                         clock_);
  runner.run_until(at(45ms));
  EXPECT_EQ(stage.instants(), (std::vector{at(3ms), at(4ms), at(24ms), at(40ms)}));
  EXPECT_EQ(runner.ledger(0).lateness.count(), 1u);  // of the timeout alone: input is due at no known instant
}

TEST_F(SimulatedRunnerTest, WakesAThreadWithBothRateAndInputForEither) {
  ScriptedInput input({at(3ms)});
  ScriptedStage stage("b", [&](std::size_t) {
    if (input.next_event() <= clock_.now()) input.take();
  });
  SimulatedRunner runner(
      {{.spec = {.name = "b", .rate_hz = 100, .event_timeout = 1s}, .stages = {&stage}, .wake = &input}},
      clock_);
  runner.run_until(at(20ms));
  EXPECT_EQ(stage.instants(), (std::vector{at(0ms), at(3ms), at(10ms), at(20ms)}));
  EXPECT_EQ(runner.ledger(0).slips, 0u);
}

TEST_F(SimulatedRunnerTest, WakesOneThreadByWhatAnotherDid) {
  std::vector<Instant> posted;
  struct Doorbell final : WakeSource {
    void wait(Instant) noexcept override {}
    Instant next_event() const noexcept override { return rung; }
    Instant rung = Instant::max();
  } doorbell;
  ScriptedStage ringer("r",
                       [&](std::size_t step) { doorbell.rung = step == 1 ? clock_.now() : doorbell.rung; });
  ScriptedStage answerer("a", [&](std::size_t) { doorbell.rung = Instant::max(); });
  SimulatedRunner runner(
      {{.spec = {.name = "r", .rate_hz = 100}, .stages = {&ringer}},
       {.spec = {.name = "a", .event_timeout = 1s}, .stages = {&answerer}, .wake = &doorbell}},
      clock_);
  runner.run_until(at(25ms));
  EXPECT_EQ(answerer.instants(), (std::vector{at(10ms)}));
}

TEST_F(SimulatedRunnerTest, IsNotStoppedByASourceThatAlwaysSaysNow) {
  ScriptedInput stuck({at(5ms)});
  ScriptedStage deaf("d");
  SimulatedRunner runner({{.spec = {.name = "d", .event_timeout = 10ms}, .stages = {&deaf}, .wake = &stuck}},
                         clock_);
  runner.run_until(at(6ms));
  EXPECT_EQ(clock_.now(), at(6ms));
  EXPECT_EQ(runner.steps(), SimulatedRunner::kMaxTurnsAtOnce + 1u);
}

TEST_F(SimulatedRunnerTest, TracesWakesStepsAndSlips) {
  TraceRing trace(15);
  const std::array<Nanos, 1> cost{15ms};
  ScriptedStage stage("a");
  SimulatedRunner runner(
      {{.spec = {.name = "a", .rate_hz = 100}, .stages = {&stage}, .trace = &trace, .virtual_costs = cost}},
      clock_);
  runner.run_until(at(0ms));
  const std::vector<TraceEvent> expected{
      {.at = at(0ms), .kind = TraceKind::wake},
      {.at = at(0ms), .length = 15ms, .kind = TraceKind::step, .value = 1},
      {.at = at(15ms), .kind = TraceKind::slip, .value = 1},
  };
  EXPECT_EQ(trace.snapshot(), expected);
}

/// A few threads whose rates beat against each other; the order of all their steps as one number (FNV-1a).
std::uint64_t hash_of_a_run() {
  SimulatedClock clock;
  std::uint64_t hash = 14'695'981'039'346'656'037u;
  const auto note = [&](std::uint64_t who) {
    hash = (hash ^ who) * 1'099'511'628'211u;
    hash = (hash ^ static_cast<std::uint64_t>(nanos_since_zero(clock.now()))) * 1'099'511'628'211u;
  };
  ScriptedStage a("a", [&](std::size_t) { note(1); });
  ScriptedStage b("b", [&](std::size_t) { note(2); });
  ScriptedStage c("c", [&](std::size_t) { note(3); });
  const std::array<Nanos, 2> costs{7ms, 4ms};
  SimulatedRunner runner({{.spec = {.name = "a", .rate_hz = 60, .fifo_priority = 3}, .stages = {&a}},
                          {.spec = {.name = "bc", .rate_hz = 100, .fifo_priority = 2},
                           .stages = {&b, &c},
                           .virtual_costs = costs}},
                         clock);
  runner.run_until(clock.now() + 10s);
  return hash;
}

TEST_F(SimulatedRunnerTest, StepsInTheSameOrderEveryTime) {
  EXPECT_EQ(hash_of_a_run(), hash_of_a_run());
}

TEST_F(SimulatedRunnerTest, AllocatesNothingWhileItRuns) {
  ScriptedStage stage("a");
  StageLedger ledger("a");
  TraceRing trace(63);
  SimulatedRunner runner(
      {{.spec = {.name = "a", .rate_hz = 100}, .stages = {&stage}, .ledgers = {&ledger}, .trace = &trace}},
      clock_);
  EXPECT_TRUE(testing::zero_allocation([&] { runner.run_until(at(1s)); }));
}

}  // namespace
}  // namespace orcart
