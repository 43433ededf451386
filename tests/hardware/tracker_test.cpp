// A tracker, or the emulator, behind a real driver: USB, serial line or network.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

#include "board/linux/tcp_link.hpp"
#include "board/linux/tty_link.hpp"
#include "board/linux/usb/libusb_bus.hpp"
#include "board/linux/usb/usb_link.hpp"
#include "firmware-host/tracker/ndi/words.hpp"
#include "firmware-host/tracker/ndi_driver.hpp"
#include "realtime/kernel/clock.hpp"
#include "tests/firmware-host/tracker/tracker_rig.hpp"
#include "tests/hardware/environment.hpp"

namespace orcart::testing {
namespace {

constexpr const char* kVariable = "ORCART_TEST_TRACKER";

/// `usb`, `usb:PORT PATH`, `usb:any` (the first there is), a device file, or HOST:PORT.
Result<std::unique_ptr<ByteLink>> open_named(const std::string& name) {
  if (name.starts_with("usb")) {
    auto bus = std::make_unique<LibusbBus>();
    UsbChoice choice{.port_path = name.size() > 4 ? name.substr(4) : ""};
    if (choice.port_path == "any") {
      const auto devices = bus->list();
      choice.port_path = devices && !devices->empty() ? devices->front().port_path : "nowhere";
    }
    auto link = UsbLink::open(std::move(bus), choice);
    if (!link) return tl::unexpected(link.error());
    return std::unique_ptr<ByteLink>(std::move(*link));
  }
  if (name.starts_with("/")) {
    auto link = TtyLink::open(name);
    if (!link) return tl::unexpected(link.error());
    return std::unique_ptr<ByteLink>(std::move(*link));
  }
  const std::size_t colon = name.find(':');
  auto link = TcpLink::open({.host = name.substr(0, colon),
                             .port = static_cast<std::uint16_t>(std::atoi(name.c_str() + colon + 1))});
  if (!link) return tl::unexpected(link.error());
  return std::unique_ptr<ByteLink>(std::move(*link));
}

bool has_line(const std::string& name) {
  return name.starts_with("usb") || name.starts_with("/");
}

class Tracker : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto name = device_named(kVariable);
    if (!name) GTEST_SKIP() << not_set(kVariable);
    auto opened = open_named(*name);
    ASSERT_TRUE(opened) << opened.error().message;
    link = std::move(*opened);
    driver = std::make_unique<NdiDriver>(two_tools(has_line(*name) ? 115'200 : 0), *link);
  }
  /// Steps the driver until `done` says so, at most for `most`.
  template <class Done>
  bool run(Nanos most, Done done) {
    const Instant end = clock.now() + most;
    while (clock.now() < end) {
      link->wait(std::min(end, driver->next_due()));
      const DriverReport report = driver->step(clock.now());
      if (done(report)) return true;
    }
    return false;
  }
  bool start() {
    return run(40s, [](const DriverReport& r) { return r.health == TrackerHealth::live; });
  }

  RealClock clock;
  std::unique_ptr<ByteLink> link;
  std::unique_ptr<NdiDriver> driver;
};

TEST_F(Tracker, IsStartedFromWhateverStateItWasLeftIn) {
  ASSERT_TRUE(start()) << driver->trouble_sentence();
  run(300ms, [](const DriverReport&) { return false; });
  for (int tool = 0; tool < 2; ++tool)
    EXPECT_EQ(driver->reply().readings()[static_cast<std::size_t>(tool)].state, ToolState::seen)
        << driver->disabled_reason(tool);
  std::printf("firmware %s, API %s, %u baud\n", std::string(driver->firmware()).c_str(),
              std::string(driver->api_revision()).c_str(), driver->baud());
}

/// ORCART_TEST_TRACKER_SECONDS, 5 where it is not set.
TEST_F(Tracker, AnswersSixtyPollsASecondWithoutAMissedReply) {
  ASSERT_TRUE(start()) << driver->trouble_sentence();
  const auto wanted = device_named("ORCART_TEST_TRACKER_SECONDS");
  const Nanos time = from_seconds(wanted ? std::atof(wanted->c_str()) : 5.0);
  const DriverCounters before = driver->counters();
  const Nanos cpu_before = thread_time();
  bool lost = false;
  run(time, [&](const DriverReport& r) {
    lost = lost || r.health == TrackerHealth::lost;
    return false;
  });
  const DriverCounters& after = driver->counters();
  const std::uint64_t polls = after.polls - before.polls;
  std::printf("%llu polls, %llu timeouts, %llu damaged, %llu skipped, %.1f us of CPU time a poll\n",
              static_cast<unsigned long long>(polls),
              static_cast<unsigned long long>(after.timeouts - before.timeouts),
              static_cast<unsigned long long>(after.crc_bad - before.crc_bad),
              static_cast<unsigned long long>(after.skipped_polls - before.skipped_polls),
              1e6 * seconds(thread_time() - cpu_before) / static_cast<double>(polls));
  EXPECT_FALSE(lost);
  EXPECT_EQ(after.timeouts, before.timeouts);
  EXPECT_EQ(after.crc_bad, before.crc_bad);
  EXPECT_GT(polls, static_cast<std::uint64_t>(20 * seconds(time)));
}

/// ORCART_TEST_TRACKER_UNPLUG and ORCART_TEST_TRACKER_PLUG are commands that pull the plug and put it back.
TEST_F(Tracker, IsFoundAgainWithItsToolsAfterItWasUnplugged) {
  const auto unplug = device_named("ORCART_TEST_TRACKER_UNPLUG");
  const auto plug = device_named("ORCART_TEST_TRACKER_PLUG");
  if (!unplug || !plug) GTEST_SKIP() << not_set("ORCART_TEST_TRACKER_UNPLUG");
  ASSERT_TRUE(start()) << driver->trouble_sentence();
  ASSERT_EQ(std::system(unplug->c_str()), 0);
  const bool noticed = run(5s, [](const DriverReport& r) { return r.health == TrackerHealth::lost; });
  EXPECT_TRUE(noticed);
  run(500ms, [](const DriverReport&) { return false; });
  EXPECT_EQ(driver->trouble(), TrackerTrouble::disconnected);
  ASSERT_EQ(std::system(plug->c_str()), 0);
  EXPECT_TRUE(run(60s, [&](const DriverReport& r) {
    return r.new_reply && driver->reply().tools[0].state == ToolState::seen;
  })) << driver->trouble_sentence();
}

TEST(TrackerDescriptors, AreAllClosedAgain) {
  const auto name = device_named(kVariable);
  if (!name) GTEST_SKIP() << not_set(kVariable);
  ASSERT_TRUE(open_named(*name)) << "and closed: libusb keeps nothing but what its first use opens";
  const auto before = open_descriptors();
  for (int i = 0; i < 5; ++i) {
    const auto link = open_named(*name);
    ASSERT_TRUE(link) << link.error().message;
  }
  EXPECT_EQ(open_descriptors(), before);
}

/// ORCART_TEST_TRACKER_TTY is the device file that the kernel's own driver makes of the bridge.
TEST(TrackerOnUsb, IsGivenBackToTheKernelsDriver) {
  const auto name = device_named(kVariable);
  const auto tty = device_named("ORCART_TEST_TRACKER_TTY");
  if (!name || !tty) GTEST_SKIP() << not_set("ORCART_TEST_TRACKER_TTY");
  ASSERT_TRUE(std::filesystem::exists(*tty));
  {
    const auto link = open_named(*name);
    ASSERT_TRUE(link) << link.error().message;
    EXPECT_FALSE(std::filesystem::exists(*tty)) << "ours alone while it is open";
  }
  RealClock clock;
  const Instant end = clock.now() + 5s;
  while (!std::filesystem::exists(*tty) && clock.now() < end) clock.sleep_until(clock.now() + 20ms);
  EXPECT_TRUE(std::filesystem::exists(*tty));
}

}  // namespace
}  // namespace orcart::testing
