// A budget missed in a running cart: counted exactly, told on the status line with its stage, and in the
// trace.
#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "firmware-host/app/trace_file.hpp"
#include "tests/path/cart_rig.hpp"
#include "tests/support/json_check.hpp"

namespace orcart::testing {
namespace {

/// Lets simulated time pass inside chosen steps of one stage: an overrun without sleeping.
class Overrun final : public StageWrapper {
 public:
  Overrun(SimulatedClock& clock, StageId victim, Nanos length)
      : clock_(clock), victim_(victim), length_(length) {}
  Stage& around(const ThreadSpec&, StageId id, Stage& stage) override {
    if (id != victim_) return stage;
    slow_ = std::make_unique<Slow>(*this, stage);
    return *slow_;
  }
  void strike(int times) { left_ = times; }

 private:
  class Slow final : public Stage {
   public:
    Slow(Overrun& all, Stage& stage) : all_(all), stage_(stage) {}
    std::string_view name() const noexcept override { return stage_.name(); }
    StepReport step(Instant now) noexcept override {
      const StepReport report = stage_.step(now);
      if (report.worked && all_.left_ > 0) {
        --all_.left_;
        all_.clock_.advance_by(all_.length_);
      }
      return report;
    }

   private:
    Overrun& all_;
    Stage& stage_;
  };
  SimulatedClock& clock_;
  StageId victim_;
  Nanos length_;
  int left_ = 0;
  std::unique_ptr<Slow> slow_;
};

struct Run {
  std::unique_ptr<CartRig> rig;
  std::unique_ptr<Overrun> overrun;
};

Run run_with(StageId victim, Nanos length, int times) {
  Run run{.rig = CartRig::create(stream()), .overrun = nullptr};
  if (!run.rig) return run;
  run.overrun = std::make_unique<Overrun>(run.rig->clock, victim, length);
  if (!run.rig->arm(nullptr, run.overrun.get(), 4095)) return run;
  run.rig->run_until(1s);
  run.overrun->strike(times);
  run.rig->run_until(2s);
  return run;
}

TEST(BudgetLedger, CountsForcedOverrunsExactlyAndNamesTheirStage) {
  const auto run = run_with(StageId::panel, 31ms, 3);
  ASSERT_TRUE(run.rig && run.rig->cart);
  const Status& status = run.rig->cart->status();
  EXPECT_EQ(status.budget_misses, 3u);
  EXPECT_EQ(status.missed_stage, "render + submit");
  const auto& ledgers = run.rig->cart->stage_ledgers();
  for (std::size_t i = 0; i < kStageCount; ++i)
    EXPECT_EQ(ledgers[i].over_bound(), kStages[i].id == StageId::panel ? 3u : 0u) << ledgers[i].name();
}

TEST(BudgetLedger, CountsSlipsAndSkippedPeriodsExactly) {
  // The panel's period is 50 ms: a turn of 120 ms is not over at two due instants after its own.
  const auto run = run_with(StageId::panel, 120ms, 2);
  ASSERT_TRUE(run.rig && run.rig->cart);
  const ThreadLedger& render = *run.rig->cart->thread_ledgers()[static_cast<std::size_t>(ThreadId::render)];
  EXPECT_EQ(render.slips, 2u);
  EXPECT_EQ(render.skipped, 4u);
}

TEST(BudgetLedger, IsAsItWasWithoutAnOverrun) {
  const auto run = run_with(StageId::panel, 0ms, 0);
  ASSERT_TRUE(run.rig && run.rig->cart);
  EXPECT_EQ(run.rig->cart->status().budget_misses, 0u);
  for (const ThreadLedger* thread : run.rig->cart->thread_ledgers()) EXPECT_EQ(thread->slips, 0u);
  EXPECT_EQ(run.rig->cart->figures().queue_drops, 0u);
}

TEST(Trace, HoldsEveryThreadsStepsAndEachFramesAndCapturesWay) {
  auto run = run_with(StageId::panel, 120ms, 1);
  ASSERT_TRUE(run.rig && run.rig->cart);
  run.rig->run_to_end();
  const std::string trace = trace_of(*run.rig->cart);
  for (const char* expected :
       {"\"name\":\"thread_name\",\"args\":{\"name\":\"pedal\"}", "\"name\":\"upload + paint\"",
        "\"name\":\"match\"", "\"name\":\"mapper\"", "\"name\":\"slip\"", "\"name\":\"waits for its flip\"",
        "\"name\":\"to its pose\"", "\"ph\":\"b\"", "\"ph\":\"e\""})
    EXPECT_NE(trace.find(expected), std::string::npos) << expected;
  EXPECT_EQ(JsonCheck::fault_in(trace), "");
}

struct Edge {
  char phase = 0;
  std::string id, name;
  double at_us = 0;
};

/// The ends of overlapping lengths, one line each, in the order of their instants: as a viewer reads them.
std::vector<Edge> edges_of(const std::string& trace) {
  std::vector<Edge> edges;
  std::istringstream in(trace);
  for (std::string line; std::getline(in, line);) {
    char phase = 0, kind[32] = "", name[64] = "";
    unsigned id = 0;
    Edge edge;
    if (std::sscanf(line.c_str(),
                    "{\"ph\":\"%c\",\"cat\":\"%31[^\"]\",\"id\":%u,\"pid\":1,\"tid\":%*d,\"name\":\"%63[^\"]"
                    "\",\"ts\":%lf",
                    &phase, kind, &id, name, &edge.at_us) != 5)
      continue;
    edge.phase = phase;
    edge.id = kind + std::to_string(id);
    edge.name = name;
    edges.push_back(std::move(edge));
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.at_us < b.at_us; });
  return edges;
}

// Perfetto counts an end that belongs to another beginning as lost data.
TEST(Trace, EndsEachLengthThatItBeganAlsoWhereThePedalIsHeld) {
  auto run = run_with(StageId::panel, 0ms, 0);
  ASSERT_TRUE(run.rig && run.rig->cart);
  run.rig->run_to_end();
  const auto edges = edges_of(trace_of(*run.rig->cart));
  std::map<std::string, std::vector<std::string>> open;
  int captures = 0;
  for (const Edge& edge : edges) {
    auto& names = open[edge.id];
    if (edge.phase == 'b') {
      names.push_back(edge.name);
      ASSERT_LE(names.size(), 2u) << edge.id << " is the frame's or capture's own";
      captures += edge.name == "capture" ? 1 : 0;
      continue;
    }
    ASSERT_FALSE(names.empty()) << edge.id << ' ' << edge.name;
    ASSERT_EQ(names.back(), edge.name) << edge.id;
    names.pop_back();
  }
  for (const auto& [id, names] : open) EXPECT_TRUE(names.empty()) << id;
  EXPECT_GT(captures, 3) << "a held pedal paints many";
}

TEST(Trace, SaysWhichFileCannotBeWritten) {
  auto rig = CartRig::create(stream());
  ASSERT_TRUE(rig && rig->arm());
  const auto written = write_trace("/nowhere/at/all/trace.json", *rig->cart);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nowhere/at/all/trace.json"), std::string::npos)
      << written.error().message;
}

}  // namespace
}  // namespace orcart::testing
