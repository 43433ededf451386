// In the guest: the driver on a real USB bridge, the emulated tracker beyond it on the host's side.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <thread>

#include "board/linux/tty_link.hpp"
#include "tests/firmware-host/tracker/tracker_rig.hpp"
#include "tests/hardware/environment.hpp"

namespace orcart::testing {
namespace {

constexpr const char* kBridge = "/dev/ttyUSB0";  // the only serial line that the guest has

class TrackerOnABridge : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened = TtyLink::open(kBridge);
    ASSERT_TRUE(opened) << opened.error().message;
    link = std::move(*opened);
    driver = std::make_unique<NdiDriver>(two_tools(), *link);
    ASSERT_TRUE(run_until_live(20s)) << driver->trouble_sentence();
  }

  void run_until(Instant end, bool stop_when_live) {
    while (clock.now() < end && !(stop_when_live && driver->health() == TrackerHealth::live)) {
      link->wait(std::min(end, driver->next_due()));
      frames += driver->step(clock.now()).new_reply ? 1 : 0;
    }
  }
  bool run_until_live(Nanos patience) {
    run_until(clock.now() + patience, true);
    return driver->health() == TrackerHealth::live;
  }
  /// What the driver has not noticed after `patience` was not noticed.
  bool run_until_not_live(Nanos patience) {
    const Instant end = clock.now() + patience;
    while (clock.now() < end && driver->health() == TrackerHealth::live) run_until(clock.now() + 5ms, false);
    return driver->health() != TrackerHealth::live;
  }

  RealClock clock;
  std::unique_ptr<TtyLink> link;
  std::unique_ptr<NdiDriver> driver;
  int frames = 0;
};

TEST_F(TrackerOnABridge, AnswersSixtyPollsASecondForAMinute) {
  const DriverCounters before = driver->counters();
  const Nanos cpu_before = thread_time();
  frames = 0;
  run_until(clock.now() + 60s, false);
  const DriverCounters& after = driver->counters();
  const std::uint64_t polls = after.polls - before.polls, replies = after.replies - before.replies;
  std::cout << "tracker: " << polls << " polls, " << replies << " replies, " << frames << " device frames, "
            << after.skipped_polls - before.skipped_polls << " polls skipped, "
            << microseconds(thread_time() - cpu_before) / static_cast<double>(polls)
            << " us of processor time a poll\n";
  EXPECT_GE(replies + 1, polls) << "only the last poll may still be under way";
  EXPECT_GE(polls, 3000u);
  EXPECT_EQ(after.crc_bad, before.crc_bad);
  EXPECT_EQ(driver->health(), TrackerHealth::live) << driver->trouble_sentence();
}

TEST_F(TrackerOnABridge, IsLostWhenUnpluggedAndLiveWithItsToolsWhenPluggedInAgain) {
  int unplugged = -1, plugged = -1;
  std::thread hand([&] { unplugged = std::system("vm-host unplug tracker"); });
  EXPECT_TRUE(run_until_not_live(20s));
  hand.join();
  ASSERT_EQ(unplugged, 0);
  const std::uint64_t restarts = driver->counters().restarts;
  hand = std::thread([&] { plugged = std::system("vm-host plug tracker"); });
  EXPECT_TRUE(run_until_live(30s)) << driver->trouble_sentence();
  hand.join();
  ASSERT_EQ(plugged, 0);
  EXPECT_GT(driver->counters().restarts, restarts) << "the tools are checked again";
  frames = 0;
  run_until(clock.now() + 1s, false);
  EXPECT_GE(frames, 30);
}

}  // namespace
}  // namespace orcart::testing
