// The report: bins, percentiles that the samples support, and a page that is whole and escaped.
#include "firmware-host/report/run_report.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/firmware-host/session/full_disk.hpp"

namespace orcart {
namespace {

std::string content_of(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

class Report : public ::testing::Test {
 protected:
  void SetUp() override {
    dir_ = std::filesystem::temp_directory_path() / ("orcart-report-" + std::to_string(getpid()));
  }
  void TearDown() override { std::filesystem::remove_all(dir_); }
  std::filesystem::path dir_;
};

TEST(DistributionBins, CoverMicrosecondToSecondAndClampOutside) {
  EXPECT_EQ(distribution_bin(0.0), 0);
  EXPECT_EQ(distribution_bin(1e-3), 0);
  EXPECT_EQ(distribution_bin(5000), kDistributionBins - 1);
  for (int bin = 1; bin < kDistributionBins; ++bin)
    EXPECT_EQ(distribution_bin(bin_lower_ms(bin) * 1.001), bin);
}

TEST(Distribution, IsJudgedAtTheHighestPercentileItsSamplesSupport) {
  Distribution few{.budget_ms = 2, .bound_ms = 3};
  fill_from_samples(few, std::vector<double>(500, 1.0));
  EXPECT_EQ(few.judged_quantile, 0.5);

  std::vector<double> samples;
  for (int i = 1; i <= 10'000; ++i) samples.push_back(i * 1e-3);  // 0.001 .. 10 ms
  Distribution many{.budget_ms = 9.95, .bound_ms = 9.99};
  fill_from_samples(many, samples);
  EXPECT_EQ(many.judged_quantile, 0.99);
  EXPECT_DOUBLE_EQ(many.judged_ms, 9.9);
  EXPECT_DOUBLE_EQ(many.p50_ms, 5.0);
  EXPECT_EQ(many.over_bound, 10u);  // 9.991 .. 10.000
  EXPECT_TRUE(many.within_budget());
}

TEST_F(Report, WritesAPageAndJsonThatNameWhatHappened) {
  RunReport report{.title = "a <run>", .frames_shown = 200, .frames_late = 1};
  report.events = {"1 frame was late: \"render\" took 31 ms"};
  report.captures = {{.unit = 1, .outcome = "painted", .edge_s = 1.5, .to_acknowledged_ms = 40}};
  ASSERT_TRUE(write_report(dir_, report).has_value());
  const std::string page = content_of(dir_ / "report.html");
  EXPECT_NE(page.find("a &lt;run&gt;"), std::string::npos);
  EXPECT_NE(page.find("0.50 %"), std::string::npos);
  const std::string json = content_of(dir_ / "report.json");
  EXPECT_NE(json.find("\"late_percent\":0.5000"), std::string::npos);
  EXPECT_NE(json.find("\\\"render\\\" took 31 ms"), std::string::npos);
}

TEST_F(Report, GivesTheRunsOfOneStreamOneRow) {
  RunReport report;
  report.captures = {{.unit = 1, .outcome = "painted"}};
  for (int i = 0; i < 3; ++i) report.captures.push_back({.unit = 2, .outcome = "painted (stream)"});
  report.captures.push_back({.unit = 3, .outcome = "painted (stream)"});
  ASSERT_TRUE(write_report(dir_, report).has_value());
  const std::string page = content_of(dir_ / "report.html");
  EXPECT_NE(page.find("painted (stream), 3 pictures"), std::string::npos);
  EXPECT_NE(page.find("<td>3</td>"), std::string::npos);
}

TEST(Summary, QuotesNoPercentileTwice) {
  RunReport report;
  report.paths = {{.name = "few", .samples = 20, .p50_ms = 2, .judged_quantile = 0.5, .judged_ms = 2},
                  {.name = "many", .samples = 2000, .p50_ms = 2, .judged_quantile = 0.9, .judged_ms = 3}};
  const std::string text = summary_of(report, {});
  EXPECT_NE(text.find("few: p50 2.0 ms of 20.\n"), std::string::npos);
  EXPECT_NE(text.find("many: p50 2.0 ms, p90 3.0 ms of 2000.\n"), std::string::npos);
}

TEST_F(Report, LeavesNoHalfOfItselfOnAFullDisk) {
  std::filesystem::create_directories(dir_);
  {
    const testing::FullDisk full(100);
    EXPECT_FALSE(write_report(dir_, {}).has_value());
  }
  EXPECT_TRUE(std::filesystem::is_empty(dir_));
}

TEST_F(Report, SaysWhereItCannotWrite) {
  std::ofstream(dir_) << "a file is in the way";
  const auto result = write_report(dir_, {});
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().message.find(dir_.string()), std::string::npos);
}

}  // namespace
}  // namespace orcart
