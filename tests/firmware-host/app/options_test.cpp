// Lengths of time as people type them, and the command line of orcartd.
#include "firmware-host/app/options.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(DurationFrom, ReadsEveryUnit) {
  EXPECT_EQ(duration_from("30s").value(), 30s);
  EXPECT_EQ(duration_from("1500ms").value(), 1500ms);
  EXPECT_EQ(duration_from("2m").value(), 2min);
  EXPECT_EQ(duration_from("2min").value(), 2min);
  EXPECT_EQ(duration_from("1h").value(), 1h);
  EXPECT_EQ(duration_from("2.5").value(), 2500ms);
  EXPECT_EQ(duration_from("24h").value(), 24h);
}

TEST(DurationFrom, RefusesWhatIsNoLengthOfTimeAndSaysWhatWouldBe) {
  for (const char* wrong : {"", "s", "abc", "30x", "30 s", "-1s", "0", "25h", "nan", "inf", "1e99s", "3s3"}) {
    const auto length = duration_from(wrong);
    ASSERT_FALSE(length) << wrong;
    EXPECT_NE(length.error().message.find("30s"), std::string::npos) << wrong;
    EXPECT_NE(length.error().message.find(wrong), std::string::npos) << wrong;
  }
}

/// What the words after the program's name mean.
tl::expected<Options, int> options_of(std::vector<std::string> words) {
  words.insert(words.begin(), "orcartd");
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  auto options = read_options(static_cast<int>(argv.size()), argv.data());
  (void)::testing::internal::GetCapturedStdout();
  (void)::testing::internal::GetCapturedStderr();
  return options;
}

TEST(ReadOptions, TakesAWholeLine) {
  const auto options = options_of({"--cart", "c.toml", "--panel", "window", "--clock", "simulated", "--for",
                                   "1500ms", "--session", "s.orcart", "--report", "out"});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->cart, "c.toml");
  EXPECT_EQ(options->panel, PanelKind::window);
  EXPECT_EQ(options->clock, ClockKind::simulated);
  EXPECT_EQ(options->run_for, Nanos{1500ms});
  EXPECT_EQ(options->session, "s.orcart");
  EXPECT_EQ(options->report_dir, "out");
}

TEST(ReadOptions, TakesTheTurnOfAnAngledScopeInDegrees) {
  EXPECT_FALSE(options_of({"--cart", "c.toml"})->turn_rad);
  EXPECT_NEAR(*options_of({"--cart", "c.toml", "--turn", "-90"})->turn_rad, -1.5707963267948966, 1e-12);
  EXPECT_EQ(options_of({"--cart", "c.toml", "--turn", "400"}).error(), 2);
}

TEST(ReadOptions, EndsWellAfterHelpAndVersionAndBadlyAfterAWrongLine) {
  EXPECT_EQ(options_of({"--help"}).error(), 0);
  EXPECT_EQ(options_of({"--version"}).error(), 0);
  EXPECT_EQ(options_of({}).error(), 2);
  EXPECT_EQ(options_of({"--cart", "c.toml", "--panel", "crt"}).error(), 2);
  EXPECT_EQ(options_of({"--cart", "c.toml", "--for", "soon"}).error(), 2);
  EXPECT_EQ(options_of({"--cart", "c.toml", "--warp"}).error(), 2);
}

}  // namespace
}  // namespace orcart
