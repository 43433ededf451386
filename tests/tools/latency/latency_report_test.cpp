// A report says how many samples stand behind each figure, and quotes no percentile that too few support.
#include "tools/latency/latency_report.hpp"

#include <gtest/gtest.h>

#include "tests/support/json_check.hpp"

namespace orcart::testing {
namespace {

/// `count` samples of 1 ms, and one of `longest`.
LatencyRow row_of(std::uint64_t count, Nanos longest, const Budget& budget = {2ms, 5ms}) {
  Histogram histogram;
  for (std::uint64_t i = 1; i < count; ++i) histogram.record(1ms);
  histogram.record(longest);
  return {
      .name = "render <&\"submit\">", .note = "a note", .budget = budget, .samples = histogram.snapshot()};
}

LatencyReport report_of(LatencyRow row) {
  LatencyReport report{
      .machine = {.name = "Test CPU", .preempt_rt = true, .fifo = true, .causes = {{"a cause", "a remedy"}}},
      .render_class = "software",
      .renderer = "llvmpipe",
      .seconds_a_run = 10,
      .panel_hz = 20};
  LatencyRun run{.title = "idle"};
  run.stages.push_back(std::move(row));
  run.capture = {{"pedal edge to flip", 0, 118.5}, {"painted", 60, 80}};
  run.worst.push_back({.stage = "mapper",
                       .at_s = 1.5,
                       .took_ms = 2.9,
                       .bound_ms = 3,
                       .trace = {"+0.000 ms mapping  mapper took 2.90 ms"}});
  report.runs.push_back(std::move(run));
  return report;
}

TEST(LatencyReport, RefusesAPercentileThatTooFewSamplesSupport) {
  EXPECT_EQ(percentile_words(row_of(9'999, 1ms).samples, 0.99), "p99 needs 10000 samples, there are 9999");
  EXPECT_EQ(percentile_words(row_of(99'999, 1ms).samples, 0.999),
            "p99.9 needs 100000 samples, there are 99999");
  EXPECT_EQ(percentile_words(row_of(10'000, 1ms).samples, 0.99), "p99 1.00 ms");
  const std::string json = json_of(report_of(row_of(9'999, 1ms)));
  EXPECT_NE(json.find("\"samples\":9999"), std::string::npos);
  EXPECT_NE(json.find("\"p90_us\":"), std::string::npos);
  EXPECT_EQ(json.find("\"p99_us\":"), std::string::npos) << json;
}

TEST(LatencyReport, JudgesAtTheQuantileThatTheSamplesSupport) {
  EXPECT_EQ(verdict_of(row_of(1'000, 1ms)), Verdict::within);
  EXPECT_EQ(verdict_of(row_of(1'000, 4ms)), Verdict::within);  // over p99.9, but that is not judged
  EXPECT_EQ(verdict_of(row_of(1'000, 6ms)), Verdict::over);    // over the hard bound: once is enough
  EXPECT_EQ(verdict_of(row_of(1'000, 1ms, {500us, 5ms})), Verdict::over);
  EXPECT_EQ(verdict_of(row_of(100, 1ms)), Verdict::too_few);
  EXPECT_EQ(verdict_of(row_of(100, 1ms, {})), Verdict::no_budget);
}

TEST(LatencyReport, TellsABoundOnceMissedFromABudgetMissedTooOften) {
  LatencyRow row = row_of(1'000, 6ms);
  EXPECT_EQ(verdict_words(row), "OVER the bound of 5.00 ms");
  row.longest_own = 1200us;
  EXPECT_EQ(verdict_words(row), "OVER the bound of 5.00 ms, the thread itself ran 1.20 ms at most");
  EXPECT_EQ(verdict_words(row_of(1'000, 1ms, {500us, 5ms})), "OVER (at p90)");
  EXPECT_EQ(verdict_words(row_of(1'000, 1ms)), "within (at p90)");
}

TEST(LatencyReport, AMissGatesOnlyOnAMachineThatIsJudged) {
  LatencyReport report = report_of(row_of(1'000, 6ms));
  EXPECT_FALSE(good_enough(report));
  report.machine.fifo = false;
  EXPECT_TRUE(good_enough(report));
  EXPECT_NE(text_of(report).find("do not gate here"), std::string::npos);
  EXPECT_NE(json_of(report).find("\"good_enough\":null"), std::string::npos);
}

TEST(LatencyReport, IsJsonWithTheWorstStepsTraceAndOneCapturesTimeline) {
  const std::string json = json_of(report_of(row_of(1'000, 1ms)));
  EXPECT_EQ(JsonCheck::fault_in(json), "");
  for (const char* part : {"\"trace\":[\"+0.000 ms mapping  mapper took 2.90 ms\"]",
                           "\"capture\":[{\"name\":\"pedal edge to flip\"", "\"remedy\":\"a remedy\""})
    EXPECT_NE(json.find(part), std::string::npos) << part;
}

TEST(LatencyReport, IsOnePageThatAsksForNoOtherFile) {
  const std::string page = page_of(report_of(row_of(1'000, 1ms)));
  for (const char* link : {"http", "src=", "href=", "@import", "url("})
    EXPECT_EQ(page.find(link), std::string::npos) << link;
  for (const char* part : {"render &lt;&amp;", ">budget<", ">bound<", "<polyline", "118.5 ms", "a remedy",
                           "1000 samples", "p99 needs 10000 samples, there are 1000"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(LatencyReport, SaysInWordsHowLongThingsTook) {
  EXPECT_EQ(words_for(Nanos{1'234}), "1.23 us");
  EXPECT_EQ(words_for(12'340us), "12.3 ms");
  EXPECT_EQ(words_for(Nanos{999'400}), "999 us");
}

}  // namespace
}  // namespace orcart::testing
