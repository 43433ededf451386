// Each cause of latency is seen in the file that shows it, and comes with its remedy.
#include "tools/latency/machine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart::testing {
namespace {

class MachineFactsTest : public ::testing::Test {
 protected:
  /// A machine as it should be.
  MachineFactsTest() {
    put("proc/cpuinfo", "model name\t: Test CPU\nflags\t\t: fpu sse2\n");
    put("proc/sys/kernel/osrelease", "6.1.0-rt");
    put("proc/sys/kernel/sched_rt_runtime_us", "-1");
    put("sys/kernel/realtime", "1");
    put(kCpu + "isolated", "2-3");
    put(kCpu + "cpu0/cpuidle/state0/latency", "0");
    put(kCpu + "cpu0/cpufreq/scaling_governor", "performance");
    put(kCpu + "cpu0/thermal_throttle/core_throttle_count", "0");
  }
  void put(const std::string& file, const std::string& text) const {
    const auto path = root_ / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  MachineFacts facts() const { return look_at_machine((root_ / "x").parent_path()); }
  /// Causes that hold `word`, but for those of this process's own rights.
  std::vector<Cause> causes(const std::string& word = "") const {
    std::vector<Cause> found;
    for (const Cause& cause : facts().causes)
      if (cause.what.find(word) != std::string::npos && !cause.what.starts_with("No right") &&
          !cause.what.starts_with("Memory"))
        found.push_back(cause);
    return found;
  }
  const std::string kCpu = "sys/devices/system/cpu/";

 private:
  TemporaryFolder root_;
};

TEST_F(MachineFactsTest, NothingIsSeenWhereAllIsAsItShouldBe) {
  EXPECT_TRUE(causes().empty()) << causes().front().what;
  EXPECT_TRUE(facts().preempt_rt);
  EXPECT_TRUE(facts().name.starts_with("Test CPU")) << facts().name;
}

TEST_F(MachineFactsTest, WallClockBudgetsGateOnlyWithPreemptRtAndTheRightToFifo) {
  EXPECT_EQ(facts().judged(), facts().fifo);
  put("sys/kernel/realtime", "0");
  EXPECT_FALSE(facts().judged());
  EXPECT_EQ(causes("PREEMPT_RT").size(), 1u);
}

TEST_F(MachineFactsTest, EachCauseHasItsRemedy) {
  put("sys/kernel/realtime", "0");
  put("proc/sys/kernel/sched_rt_runtime_us", "950000");
  put("proc/cpuinfo", "model name\t: Test CPU\nflags\t\t: fpu hypervisor sse2\n");
  put(kCpu + "isolated", "");
  put(kCpu + "cpu0/cpuidle/state2/latency", "133");
  put(kCpu + "cpu0/cpufreq/scaling_governor", "powersave");
  put(kCpu + "cpu0/thermal_throttle/core_throttle_count", "7");
  for (const char* word : {"PREEMPT_RT", "950000 us in every 1000000 us", "virtual machine", "isolated",
                           "133 us to wake", "governor powersave", "throttled 7 times"})
    ASSERT_EQ(causes(word).size(), 1u) << word;
  for (const Cause& cause : causes()) EXPECT_FALSE(cause.remedy.empty()) << cause.what;
}

TEST_F(MachineFactsTest, ASleepThatIsSwitchedOffIsNoCause) {
  put(kCpu + "cpu0/cpuidle/state2/latency", "133");
  put(kCpu + "cpu0/cpuidle/state2/disable", "1");
  EXPECT_TRUE(causes("to wake").empty());
}

}  // namespace
}  // namespace orcart::testing
