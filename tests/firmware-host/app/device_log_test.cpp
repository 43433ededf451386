// A device that goes is told once, and once when it is back; so is a turn that the notch contradicts.
#include "firmware-host/app/device_log.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(DeviceLog, TellsADeviceThatGoesAndComesBackOnceEach) {
  DeviceLog log;
  Cart::Now now;
  EXPECT_EQ(log.news(now), "");
  now.encoder = PortFault::disconnected;
  EXPECT_EQ(log.news(now), "encoder: disconnected; tried again until it works\n");
  EXPECT_EQ(log.news(now), "");
  now.encoder = PortFault::nothing_yet;
  EXPECT_EQ(log.news(now), "encoder: works again\n");
}

TEST(DeviceLog, TellsOfFramesThatAllComeDamagedAndWhatMayHelp) {
  DeviceLog log;
  Cart::Now now;
  now.camera = PortFault::damaged;
  EXPECT_EQ(log.news(now),
            "camera: every frame comes damaged; another cable, port or format of the camera may do\n");
}

TEST(DeviceLog, TellsWhyTheTrackerDoesNotTrackAndWhatDoesNotPleaseWhileItDoes) {
  DeviceLog log;
  Cart::Now now;
  now.tracker = "the tracker refuses a command for tool SCOPE: the tool definition is damaged";
  EXPECT_EQ(
      log.news(now),
      "tracker: the tracker refuses a command for tool SCOPE: the tool definition is damaged; tried again "
      "until it works\n");
  EXPECT_EQ(log.news(now), "");
  now.tracker = "";
  now.tracker_remark = "the device measures at 20 Hz, not at the 60 Hz of rate_hz; write what it does";
  EXPECT_EQ(log.news(now),
            "tracker: works again\n"
            "tracker: the device measures at 20 Hz, not at the 60 Hz of rate_hz; write what it does\n");
  EXPECT_EQ(log.news(now), "");
}

TEST(DeviceLog, TellsATurnThatTheNotchContradictsOnceAndWhenTheyAgreeAgain) {
  DeviceLog log;
  Cart::Now now;
  now.mismatch_deg = -6;
  EXPECT_EQ(
      log.news(now),
      "turn: the notch in the pictures is -6 degrees further round; nothing is painted until they agree\n");
  now.mismatch_deg = -7;
  EXPECT_EQ(log.news(now), "");
  now.mismatch_deg = 0;
  EXPECT_EQ(log.news(now), "turn: agrees with the notch again\n");
}

TEST(DeviceLog, TellsASessionThatIsNotKeptOnceAndWhenItIsAgain) {
  DeviceLog log;
  Cart::Now now;
  now.session_failing = true;
  now.session_lost = 1;
  EXPECT_EQ(
      log.news(now),
      "session: writing fails, captures are not kept (1 lost so far); make room on the disk, it is tried "
      "again until it works\n");
  now.session_lost = 7;
  EXPECT_EQ(log.news(now), "");
  now.session_failing = false;
  EXPECT_EQ(log.news(now), "session: captures are kept again (7 lost so far)\n");
  EXPECT_EQ(log.news(now), "");
}

TEST(DeviceLog, TellsTheFirstCaptureThatASlowDiskLost) {
  DeviceLog log;
  Cart::Now now;
  now.session_lost = 2;
  EXPECT_EQ(log.news(now), "session: the disk is too slow, captures are not kept (2 lost so far)\n");
  now.session_lost = 3;
  EXPECT_EQ(log.news(now), "");
}

}  // namespace
}  // namespace orcart
