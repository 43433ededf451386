// How many instructions each step takes at its worst case: capped 2 % above what was counted when the cap was
// set, and growing no faster than its work.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace orcart::testing {
namespace {

namespace fs = std::filesystem;

constexpr double kTolerance = 1.02, kGrowth = 2.02;

using Counts = std::map<std::string, std::map<int, double>>;  ///< step -> size -> instructions

/// "desc: Trigger: Client Request: match-64" and "totals: 12345" of each dump.
Counts counts_in(const fs::path& folder) {
  Counts counts;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream in(entry.path());
    std::string name;
    double total = 0;
    for (std::string line; std::getline(in, line);) {
      constexpr std::string_view kTrigger = "desc: Trigger: Client Request: ";
      if (line.starts_with(kTrigger)) name = line.substr(kTrigger.size());
      if (line.starts_with("totals: ")) total = std::stod(line.substr(8));
      if (line.starts_with("summary: ") && total == 0) total = std::stod(line.substr(9));
    }
    const auto dash = name.rfind('-');
    if (dash != std::string::npos) counts[name.substr(0, dash)][std::stoi(name.substr(dash + 1))] = total;
  }
  return counts;
}

/// Lines of "step size instructions".
Counts caps_in(const fs::path& file) {
  Counts caps;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    char step[64];
    int size = 0;
    double instructions = 0;
    if (std::sscanf(line.c_str(), "%63s %d %lf", step, &size, &instructions) == 3 && step[0] != '#')
      caps[step][size] = instructions;
  }
  return caps;
}

fs::path baseline() {
  return fs::path(std::getenv("ORCART_SOURCE_DIR")) / "tests/budget/instructions" /
#if defined(__clang__)
         ("clang-" + std::to_string(__clang_major__) + ".txt");
#else
         ("gcc-" + std::to_string(__GNUC__) + ".txt");
#endif
}

class InstructionCaps : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (std::system("valgrind --version >/dev/null 2>&1") != 0) return;
    const fs::path folder = fs::temp_directory_path() / ("orcart-callgrind-" + std::to_string(getpid()));
    fs::create_directories(folder);
    const std::string command =
        "cd '" + folder.string() +
        "' && valgrind --tool=callgrind --collect-atstart=no --callgrind-out-file=out '" +
        ORCART_COUNTED_STEPS + "' >log 2>&1";
    const int status = std::system(command.c_str());
    if (status == 0) counts = counts_in(folder);
    fs::remove_all(folder);
    constexpr int kNoAvx2 = 77;
    lack = WIFEXITED(status) && WEXITSTATUS(status) == kNoAvx2
               ? "the counts are for AVX2, which this processor lacks"
               : "";
  }
  void SetUp() override {
    if (!lack.empty()) GTEST_SKIP() << lack;
    ASSERT_EQ(counts.size(), 5u) << "pedal, tracker, camera, match and mapper";
  }
  static inline Counts counts;
  static inline std::string lack = "valgrind is not installed";
};

TEST_F(InstructionCaps, NoStepTakesTwoPercentMoreThanItsCap) {
  const Counts caps = caps_in(baseline());
  for (const auto& [step, sizes] : counts)
    for (const auto& [size, instructions] : sizes)
      std::printf("%s %d %.0f\n", step.c_str(), size, instructions);
  if (caps.empty()) GTEST_SKIP() << "no caps for this compiler: " << baseline();
  for (const auto& [step, sizes] : caps)
    for (const auto& [size, cap] : sizes) {
      ASSERT_TRUE(counts.contains(step) && counts[step].contains(size)) << step << " " << size;
      EXPECT_LE(counts[step][size], cap * kTolerance) << step << " " << size;
    }
}

TEST_F(InstructionCaps, TwiceTheWorkIsAtMostTwiceTheInstructions) {
  for (const auto& [step, sizes] : counts) {
    ASSERT_EQ(sizes.size(), 2u) << step;
    const auto once = *sizes.begin(), twice = *sizes.rbegin();
    ASSERT_EQ(twice.first, 2 * once.first) << step;
    EXPECT_LE(twice.second / once.second, kGrowth) << step;
  }
}

}  // namespace
}  // namespace orcart::testing
