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
constexpr int kNoAvx2 = 77;  // exit status; see counted.hpp

using Counts = std::map<std::string, std::map<int, double>>;  ///< step -> size -> instructions

/// Which of callgrind's "ob=(3) PATH", and of "ob=(3)" ever after, is `program`.
class Objects {
 public:
  explicit Objects(std::string program) : program_(std::move(program)) {}
  bool is_ours(const std::string& line) {
    const auto end = line.find(')');
    if (end + 2 < line.size()) ours_[line.substr(0, end)] = line.substr(end + 2) == program_;
    return ours_[line.substr(0, end)];
  }

 private:
  std::string program_;
  std::map<std::string, bool> ours_;
};

/// Adds "desc: Trigger: Client Request: match-64" of each dump with the instructions in it: of `program`
/// itself where it is named, without the libraries it calls; else all. The lines are those of callgrind's
/// manual, "file format".
void add_counts(const fs::path& folder, const std::string& program, Counts& counts) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream in(entry.path());
    std::string name;
    double all = 0, own = 0;
    bool ours = false, of_callee = false;
    Objects objects(program);
    for (std::string line; std::getline(in, line);) {
      constexpr std::string_view kTrigger = "desc: Trigger: Client Request: ";
      if (line.starts_with(kTrigger)) name = line.substr(kTrigger.size());
      if (line.starts_with("ob=") || line.starts_with("cob=")) {
        const bool of_program = objects.is_ours(line.substr(line.find('=') + 1));
        if (line.starts_with("ob=")) ours = of_program;
      }
      double cost = 0;
      if (!line.empty() && std::string_view("+-*0123456789").find(line[0]) != std::string_view::npos &&
          std::sscanf(line.c_str(), "%*s %lf", &cost) == 1) {
        if (!of_callee) (ours ? own : all) += cost;
        of_callee = false;
      }
      if (line.starts_with("calls=")) of_callee = true;
    }
    const auto dash = name.rfind('-');
    if (dash != std::string::npos)
      counts[name.substr(0, dash)][std::stoi(name.substr(dash + 1))] = program.empty() ? all + own : own;
  }
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
    lack.clear();
    count(ORCART_COUNTED_STEPS, "");
    if (lack.empty()) count(ORCART_COUNTED_PAINTING, ORCART_COUNTED_PAINTING);
  }
  static void count(const std::string& command, const std::string& only) {
    const fs::path folder = fs::temp_directory_path() / ("orcart-callgrind-" + std::to_string(getpid()));
    fs::create_directories(folder);
    const int status =
        std::system(("cd '" + folder.string() +
                     "' && valgrind --tool=callgrind --collect-atstart=no --callgrind-out-file=out '" +
                     command + "' >log 2>&1")
                        .c_str());
    if (status == 0) add_counts(folder, only, counts);
    fs::remove_all(folder);
    if (WIFEXITED(status) && WEXITSTATUS(status) == kNoAvx2)
      lack = "the counts are for AVX2, which this processor lacks";
  }
  void SetUp() override {
    if (!lack.empty()) GTEST_SKIP() << lack;
    ASSERT_EQ(counts.size(), 13u) << "pedal, tracker, camera, notch, match, mapper, cutout, clip, ranges, "
                                     "painting and drawing (twice each)";
  }
  static inline Counts counts;
  static inline std::string lack = "valgrind is not installed";
};

// One test, because ctest starts a program for each and counting takes its time.
TEST_F(InstructionCaps, NoStepExceedsItsCapNorTwiceItsInstructionsForTwiceTheWork) {
  for (const auto& [step, sizes] : counts) {
    for (const auto& [size, instructions] : sizes)
      std::printf("%s %d %.0f\n", step.c_str(), size, instructions);
    ASSERT_EQ(sizes.size(), 2u) << step;
    const auto once = *sizes.begin(), twice = *sizes.rbegin();
    ASSERT_EQ(twice.first, 2 * once.first) << step;
    EXPECT_LE(twice.second / once.second, kGrowth) << step;
  }
  const Counts caps = caps_in(baseline());
  if (caps.empty()) GTEST_SKIP() << "no caps for this compiler: " << baseline();
  for (const auto& [step, sizes] : caps)
    for (const auto& [size, cap] : sizes) {
      ASSERT_TRUE(counts.contains(step) && counts[step].contains(size)) << step << " " << size;
      EXPECT_LE(counts[step][size], cap * kTolerance) << step << " " << size;
    }
}

}  // namespace
}  // namespace orcart::testing
