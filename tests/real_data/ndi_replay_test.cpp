// A recorded session of a real Polaris drives the shipping driver.
#include <gtest/gtest.h>

#include "firmware-host/tracker/ndi_driver.hpp"
#include "firmware-host/tracker/replay_byte_link.hpp"
#include "realtime/kernel/clock.hpp"
#include "tests/real_data/data_folder.hpp"

namespace orcart::testing {
namespace {

TEST(ReplayByteLink, LetsARecordedPolarisDriveTheDriver) {
  const auto folder = data_folder("ndi_polaris_dev");
  if (!folder) GTEST_SKIP() << kNoData;
  const auto dialogue =
      ndi::read_dialogue(*folder / "polaris_stream_08_31_2005_NDICommandInterpreter.records_0-110.txt");
  const auto tool = ndi::read_tool_definition(*folder / "polaris_passive_pointer_1.rom");
  ASSERT_TRUE(dialogue && tool);
  SimulatedClock clock;
  ReplayByteLink link(*dialogue, clock);
  NdiDriver driver({.tools = {*tool}, .device_rate_hz = 20, .baud = 57600}, link);
  std::uint64_t new_replies = 0;
  const Instant end = clock.now() + 60s;
  while (!link.finished() && clock.now() < end) {
    link.wait(driver.next_due());
    new_replies += driver.step(clock.now()).new_reply ? 1 : 0;
  }
  EXPECT_TRUE(link.finished()) << driver.trouble_sentence();
  const DriverCounters& counters = driver.counters();
  EXPECT_EQ(counters.replies, 50u) << "the recording's BX:0001";
  EXPECT_EQ(counters.unknown_handles, 50u) << "its second, wired tool is none of ours";
  EXPECT_EQ(counters.crc_bad, 0u);
  EXPECT_EQ(counters.missing[0], new_replies) << "the passive pointer was never seen in it";
  EXPECT_EQ(new_replies + counters.repeats, counters.replies);
  EXPECT_GT(new_replies, 20u);
}

}  // namespace
}  // namespace orcart::testing
