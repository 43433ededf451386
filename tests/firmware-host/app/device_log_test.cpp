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

}  // namespace
}  // namespace orcart
