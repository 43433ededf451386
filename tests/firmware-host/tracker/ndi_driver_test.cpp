// The driver against the emulated tracker: start, polling, and each fault noticed in time.
#include "firmware-host/tracker/ndi_driver.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "realtime/base/crc16.hpp"
#include "tests/firmware-host/tracker/tracker_rig.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

/// Runs until `done` says so of a report, and tells how long that took; fails after `most`.
template <class Done>
Nanos time_until(TrackerRig& rig, Nanos most, Done done) {
  const Instant begin = rig.clock.now();
  Instant seen = Instant::max();
  while (seen == Instant::max() && rig.clock.now() < begin + most) {
    rig.run_until(std::min(begin + most, rig.driver_due()), [&](const DriverReport& report) {
      if (seen == Instant::max() && done(report)) seen = rig.clock.now();
    });
  }
  EXPECT_NE(seen, Instant::max()) << "not noticed at all";
  return seen == Instant::max() ? most : seen - begin;
}

/// A text reply as it goes over the line.
std::string with_crc(const std::string& text) {
  char crc[8];
  std::snprintf(crc, sizeof crc, "%04X\r", crc16(std::as_bytes(std::span(text))));
  return text + crc;
}

TEST(NdiDriver, StartsADeviceAtItsPowerOnRateAndGoesToTheWantedOne) {
  TrackerRig rig;
  rig.start();
  EXPECT_EQ(rig.device.baud(rig.clock.now()), 115200u);
  EXPECT_EQ(rig.driver.baud(), 115200u);
  EXPECT_TRUE(rig.device.tracking());
  EXPECT_EQ(rig.driver.counters().restarts, 0u);
}

TEST(NdiDriver, FindsADeviceThatWasLeftTrackingAtTheWantedRateAtOnceAndWithoutABreak) {
  TrackerRig rig;
  rig.start();
  rig.link.breaks = 0;
  NdiDriver second(two_tools(), rig.link);
  const Instant end = rig.clock.now() + 1s;
  while (second.health() != TrackerHealth::live && rig.clock.now() < end) {
    rig.link.wait(second.next_due());
    second.step(rig.clock.now());
  }
  EXPECT_EQ(second.health(), TrackerHealth::live) << second.trouble_sentence();
  EXPECT_EQ(rig.link.breaks, 0);
}

TEST(NdiDriver, StartsADeviceThatWasLeftTrackingAtAnotherRate) {
  TrackerRig rig(two_tools(57600));
  rig.start();
  NdiDriver second(two_tools(115200), rig.link);
  const Instant end = rig.clock.now() + 5s;
  while (second.health() != TrackerHealth::live && rig.clock.now() < end) {
    rig.link.wait(second.next_due());
    second.step(rig.clock.now());
  }
  EXPECT_EQ(second.health(), TrackerHealth::live) << second.trouble_sentence();
}

TEST(NdiDriver, HasEveryFrameReportedThoughAnotherHostSaidOtherwise) {
  TrackerRig rig(two_tools(0), {.has_line = false});
  constexpr std::string_view kThird = "SET Param.Tracking.Track Frequency=0\r";
  rig.device.receive(std::as_bytes(std::span(kThird)), rig.clock.now());
  rig.clock.advance_by(10ms);
  rig.device.discard(rig.clock.now());
  rig.start();
  int reported = 0;
  rig.run_for(1s, [&](const DriverReport& report) { reported += report.new_reply ? 1 : 0; });
  EXPECT_GE(reported, 58);
}

TEST(NdiDriver, StartsANetworkDeviceWithoutTouchingALine) {
  TrackerRig rig(two_tools(0), {.has_line = false});
  rig.start();
  EXPECT_EQ(rig.device.baud(rig.clock.now()), 9600u);
}

TEST(NdiDriver, ReportsEachDeviceFrameOnceForAMinuteWithoutAMissedReply) {
  TrackerRig rig(two_tools(), {.clock_drift_ppm = 60});
  rig.start();
  rig.run_for(100ms);
  std::uint32_t last = rig.driver.reply().device_frame;
  int reported = 0;
  rig.run_for(60s, [&](const DriverReport& report) {
    if (!report.new_reply) return;
    EXPECT_GT(rig.driver.reply().device_frame, last);
    last = rig.driver.reply().device_frame;
    ++reported;
  });
  const DriverCounters& counters = rig.driver.counters();
  EXPECT_EQ(counters.timeouts, 0u);
  EXPECT_EQ(counters.crc_bad, 0u);
  EXPECT_EQ(counters.skipped_polls, 0u);
  EXPECT_EQ(counters.restarts, 0u);
  EXPECT_GE(counters.polls, 3600u);
  EXPECT_LE(counters.polls - counters.replies, 1u) << "one may be on its way";
  EXPECT_GE(reported, 3598);
}

TEST(NdiDriver, SaysWhereTheToolsAreAtTheDeviceFrame) {
  TrackerRig rig;
  rig.start();
  rig.run_for(50ms);
  const TrackerReply& reply = rig.driver.reply();
  ASSERT_EQ(reply.tool_count, 2);
  for (int tool = 0; tool < 2; ++tool) {
    const ToolReading& reading = reply.readings()[static_cast<std::size_t>(tool)];
    const TrueToolPose truth =
        rig.motion.pose_of(tool, rig.device.device_clock().measured_at(reply.device_frame));
    EXPECT_EQ(reading.state, ToolState::seen);
    EXPECT_LT((reading.translation_mm - truth.translation_mm).norm(), 1e-3);
    EXPECT_LT(reading.quaternion.angularDistance(truth.rotation), 1e-6);
  }
  EXPECT_GT(reply.arrived_at, reply.asked_at);
}

TEST(NdiDriver, TellsAHiddenToolWithinAPeriodAndFiveMilliseconds) {
  TrackerRig rig;
  rig.start();
  rig.run_for(103ms);
  rig.motion.hidden = 0;
  // The device itself needs a frame and its latency before it can say so; the bound is on what comes after.
  const Nanos device = period_of(60) + 4ms;
  const Nanos took = time_until(rig, 1s, [&](const DriverReport& r) {
    return r.new_reply && rig.driver.reply().tools[0].state == ToolState::unseen;
  });
  EXPECT_LE(took, device + period_of(60) + 5ms);
  EXPECT_EQ(rig.driver.reply().tools[1].state, ToolState::seen);
  EXPECT_GE(rig.driver.counters().missing[0], 1u);
}

TEST(NdiDriver, ReadsThroughADamagedReplyAndGoesOnWithTheNext) {
  TrackerRig rig;
  rig.start();
  rig.run_for(100ms);
  const Instant now = rig.clock.now();
  rig.device.faults().add({.fault = NdiFault::bad_crc, .from = now, .until = now + 20ms});
  rig.run_for(200ms, [](const DriverReport& r) { EXPECT_EQ(r.health, TrackerHealth::live); });
  EXPECT_GE(rig.driver.counters().crc_bad, 1u);
  EXPECT_EQ(rig.driver.counters().restarts, 0u);
}

TEST(NdiDriver, CallsThreeDamagedRepliesInARowTrouble) {
  TrackerRig rig;
  rig.start();
  rig.run_for(100ms);
  const Instant now = rig.clock.now();
  rig.device.faults().add({.fault = NdiFault::bad_crc, .from = now, .until = now + 50ms});
  const Nanos took =
      time_until(rig, 1s, [](const DriverReport& r) { return r.health != TrackerHealth::live; });
  EXPECT_LE(took, 50ms + period_of(60) + 5ms);
  EXPECT_GE(rig.driver.counters().crc_bad, 3u);
}

TEST(NdiDriver, CallsOneDamagedReplyInAHundredTroubleAndKeepsTracking) {
  TrackerRig rig;
  rig.start();
  rig.device.faults().add({.fault = NdiFault::bad_crc, .from = rig.clock.now(), .every = 90});
  const Nanos took =
      time_until(rig, 20s, [](const DriverReport& r) { return r.trouble == TrackerTrouble::bad_crc; });
  EXPECT_LE(took, 10s);
  EXPECT_EQ(rig.driver.health(), TrackerHealth::live);
  EXPECT_EQ(rig.driver.counters().restarts, 0u);
}

TEST(NdiDriver, ToleratesOneDamagedReplyInTwoHundred) {
  TrackerRig rig;
  rig.start();
  rig.device.faults().add({.fault = NdiFault::bad_crc, .from = rig.clock.now(), .every = 200});
  rig.run_for(20s, [](const DriverReport& r) { EXPECT_EQ(r.trouble, TrackerTrouble::none); });
}

TEST(NdiDriver, IsSuspectAfterThreePeriodsOfSilenceAndLostAfterAHundredMilliseconds) {
  TrackerRig rig;
  rig.start();
  rig.run_for(100ms);
  rig.device.faults().add(
      {.fault = NdiFault::silence, .from = rig.clock.now(), .until = rig.clock.now() + 2s});
  const Instant begin = rig.clock.now();
  const Nanos suspect =
      time_until(rig, 1s, [](const DriverReport& r) { return r.health == TrackerHealth::suspect; });
  const Instant last_reply = rig.link.last_arrival();
  EXPECT_EQ(begin + suspect, last_reply + 3 * period_of(60));
  const Nanos lost =
      time_until(rig, 1s, [](const DriverReport& r) { return r.health == TrackerHealth::lost; });
  EXPECT_EQ(begin + suspect + lost, last_reply + 100ms);
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::silent);
}

TEST(NdiDriver, ComesBackFromSilenceByItselfWithItsToolsLoadedAgain) {
  TrackerRig rig;
  rig.start();
  rig.device.faults().add(
      {.fault = NdiFault::silence, .from = rig.clock.now(), .until = rig.clock.now() + 2s});
  rig.run_for(1s);
  EXPECT_EQ(rig.driver.health(), TrackerHealth::lost);
  rig.start(15s);
  EXPECT_GE(rig.driver.counters().restarts, 1u);
  rig.run_for(50ms);
  EXPECT_EQ(rig.driver.reply().tools[0].state, ToolState::seen);
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::none);
}

TEST(NdiDriver, ComesBackFromAResetInTheMiddle) {
  TrackerRig rig;
  rig.start();
  rig.device.faults().add({.fault = NdiFault::reset, .from = rig.clock.now() + 500ms});
  rig.run_for(700ms);
  EXPECT_EQ(rig.driver.health(), TrackerHealth::lost);
  rig.start(15s);
}

TEST(NdiDriver, CallsAStandingFrameNumberLostAfterThreePeriods) {
  TrackerRig rig;
  rig.start();
  rig.run_for(100ms);
  (void)time_until(rig, 100ms, [](const DriverReport& r) { return r.new_reply; });
  const Instant now = rig.clock.now();
  rig.device.faults().add({.fault = NdiFault::frozen_frame, .from = now, .until = now + 1s});
  const Nanos took =
      time_until(rig, 1s, [](const DriverReport& r) { return r.health == TrackerHealth::lost; });
  EXPECT_LE(took, 4 * period_of(60)) << "3 periods after the last reply with a new frame";
  EXPECT_GE(took, 2 * period_of(60));
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::frame_stuck);
  rig.start(15s);
}

TEST(NdiDriver, SaysWhyAToolIsDisabled) {
  TrackerRig rig;
  rig.start();
  rig.run_for(100ms);
  rig.device.faults().add(
      {.fault = NdiFault::unplugged, .from = rig.clock.now(), .until = rig.clock.now() + 10s, .amount = 1});
  rig.run_for(200ms);
  EXPECT_EQ(rig.driver.reply().tools[0].state, ToolState::seen);
  EXPECT_EQ(rig.driver.reply().tools[1].state, ToolState::disabled);
  EXPECT_TRUE(rig.driver.disabled_reason(1).starts_with("no tool in the port"))
      << rig.driver.disabled_reason(1);
  EXPECT_EQ(rig.driver.disabled_reason(0), "ready");
}

TEST(NdiDriver, CountsHandlesThatNobodyHasAndBelievesNone) {
  TrackerRig rig;
  rig.start();
  rig.run_for(100ms);
  const Instant now = rig.clock.now();
  rig.device.faults().add({.fault = NdiFault::wrong_handle, .from = now, .until = now + 30ms});
  rig.run_for(30ms);
  EXPECT_GE(rig.driver.counters().unknown_handles, 2u);
  EXPECT_NE(rig.driver.reply().tools[0].state, ToolState::seen);
}

TEST(NdiDriver, PassesOnThatThereIsTooMuchInfrared) {
  TrackerRig rig;
  rig.start();
  rig.device.faults().add({.fault = NdiFault::infrared, .from = rig.clock.now()});
  rig.run_for(100ms);
  EXPECT_EQ(rig.driver.reply().system_status, 0x0002);
}

TEST(NdiDriver, SurvivesNoiseTruncationAndLateness) {
  for (const NdiFault fault : {NdiFault::garbage, NdiFault::truncated, NdiFault::late}) {
    TrackerRig rig;
    rig.start();
    rig.run_for(100ms);
    const Instant now = rig.clock.now();
    rig.device.faults().add({.fault = fault, .from = now, .until = now + 30ms, .amount = 40});
    rig.run_for(500ms, [](const DriverReport& r) { EXPECT_NE(r.health, TrackerHealth::lost); });
    EXPECT_EQ(rig.driver.health(), TrackerHealth::live);
    EXPECT_EQ(rig.driver.counters().restarts, 0u);
    EXPECT_GE(rig.driver.counters().crc_bad + rig.driver.counters().timeouts, 1u);
  }
}

TEST(NdiDriver, OpensTheLinkAgainAfterItWasUnplugged) {
  TrackerRig rig;
  rig.start();
  rig.run_for(100ms);
  rig.cable.unplug();
  const Nanos took =
      time_until(rig, 1s, [](const DriverReport& r) { return r.health == TrackerHealth::lost; });
  EXPECT_LE(took, 20ms);
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::disconnected);
  rig.run_for(3s);
  rig.cable.plug_in();
  rig.start(15s);
}

TEST(NdiDriver, LetsTheThreadTurnBetweenTwoTriesOfALinkThatIsSlowToOpen) {
  TrackerRig rig;
  rig.start();
  rig.link.reopen_takes = 300ms;
  rig.cable.unplug();
  rig.run_for(20s);
  EXPECT_GE(rig.link.reopens, 5);
  EXPECT_GE(rig.link.shortest_pause, 20ms) << "counted from the try's beginning there was none";
}

TEST(NdiDriver, TracksAToolOfWhichTheDeviceWarns) {
  for (const std::string warning : {"WARNING7423\r", "WARNING05"}) {
    TrackerRig rig;
    bool initialising = false;
    int warned = 0;
    rig.link.on_write = [&](const std::string& command) { initialising = command.starts_with("PINIT"); };
    rig.link.on_read = [&](std::string& reply) {
      if (!initialising) return;
      ASSERT_EQ(reply, "OKAYA896\r");
      reply = warning.ends_with('\r') ? warning : with_crc(warning);
      ++warned;
    };
    rig.start();
    EXPECT_EQ(warned, 2);
    rig.run_for(100ms);
    EXPECT_EQ(rig.driver.reply().tools[0].state, ToolState::seen);
  }
}

TEST(NdiDriver, AsksAgainWhereACommandWasDamagedOnItsWay) {
  // Another option: ERROR04. A name that nobody knows, in the form without a CRC: ERROR01.
  for (const std::string arrives : {"", "BY 0801\r"}) {
    TrackerRig rig;
    rig.start();
    rig.run_for(200ms);
    const PollForm form = rig.driver.poll_form();
    int damaged = 0;
    int polls = 0;
    rig.link.on_write = [&](std::string& command) {
      if (++polls % 30 != 0) return;
      command[5] ^= 0x01;
      if (!arrives.empty()) command = arrives;
      ++damaged;
    };
    rig.run_for(10s, [](const DriverReport& r) { EXPECT_EQ(r.health, TrackerHealth::live); });
    EXPECT_GE(damaged, 15);
    EXPECT_EQ(rig.driver.counters().restarts, 0u);
    EXPECT_EQ(rig.driver.poll_form(), form);
    EXPECT_GE(rig.driver.counters().crc_bad, 15u);
  }
}

TEST(NdiDriver, GivesUpADeviceThatRefusesThreePollsInARow) {
  TrackerRig rig;
  rig.start();
  rig.run_for(200ms);
  rig.link.on_write = [](std::string& command) { command[5] ^= 0x01; };
  const Nanos took =
      time_until(rig, 1s, [](const DriverReport& r) { return r.health == TrackerHealth::lost; });
  EXPECT_LE(took, 5 * period_of(60));
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::device_refuses);
  EXPECT_EQ(rig.driver.trouble_sentence(), "the tracker refuses a command: the command's CRC is wrong");
  rig.link.on_write = {};
  rig.start();
}

TEST(NdiDriver, SaysWhichToolTheDeviceRefused) {
  NdiSettings settings = two_tools();
  settings.tools[1].definition.memory[80] ^= std::byte{1};
  TrackerRig rig(std::move(settings));
  rig.run_for(5s);
  EXPECT_EQ(rig.driver.health(), TrackerHealth::starting);
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::device_refuses);
  EXPECT_EQ(rig.driver.trouble_sentence(),
            "the tracker refuses a command for tool REFERENCE: the tool definition is damaged");
}

TEST(NdiDriver, SaysThatNothingAnswersAndKeepsTrying) {
  TrackerRig rig;
  rig.device.faults().add(
      {.fault = NdiFault::silence, .from = rig.clock.now(), .until = rig.clock.now() + 9s});
  rig.run_for(8s);
  EXPECT_EQ(rig.driver.health(), TrackerHealth::starting);
  rig.start(30s);
}

TEST(NdiDriver, AsksForNoMemoryOncePolling) {
  TrackerRig rig;
  rig.start();
  rig.run_for(1s);
  EXPECT_TRUE(zero_allocation([&] {
    const Instant end = rig.clock.now() + 1s;
    while (rig.clock.now() < end) {
      rig.link.wait(rig.driver.next_due());
      rig.driver.step(rig.clock.now());
    }
  }));
}

TEST(NdiDriver, AsksForNoMemoryWhileItStartsAgain) {
  TrackerRig rig;
  rig.start();
  rig.device.faults().add({.fault = NdiFault::reset, .from = rig.clock.now() + 100ms});
  EXPECT_TRUE(zero_allocation([&] {
    const Instant end = rig.clock.now() + 5s;
    while (rig.clock.now() < end) {
      rig.link.wait(rig.driver.next_due());
      rig.driver.step(rig.clock.now());
    }
  }));
  EXPECT_EQ(rig.driver.health(), TrackerHealth::live);
}

NdiSettings asking_by(PollForm form, std::uint32_t baud = 921600) {
  NdiSettings settings = two_tools(baud);
  settings.poll = form;
  return settings;
}

TEST(NdiDriver, TellsTheSamePosesHoweverItAsksForThem) {
  for (const PollForm form : {PollForm::tx, PollForm::bx, PollForm::bx2}) {
    TrackerRig rig(asking_by(form));
    rig.start();
    rig.run_for(500ms);
    EXPECT_EQ(rig.driver.poll_form(), form);
    const TrackerReply& reply = rig.driver.reply();
    for (int tool = 0; tool < 2; ++tool) {
      const ToolReading& reading = reply.readings()[static_cast<std::size_t>(tool)];
      const TrueToolPose truth =
          rig.motion.pose_of(tool, rig.device.device_clock().measured_at(reply.device_frame));
      EXPECT_EQ(reading.state, ToolState::seen);
      EXPECT_LT((reading.translation_mm - truth.translation_mm).norm(), 0.02)
          << "TX has hundredths of a millimetre";
      EXPECT_LT(reading.quaternion.angularDistance(truth.rotation), 3e-4);
    }
    EXPECT_EQ(rig.driver.counters().timeouts, 0u);
    EXPECT_EQ(rig.driver.counters().crc_bad, 0u);
  }
}

TEST(NdiDriver, AsksAVegaForFramesAndAnOlderPolarisForWhatItKnows) {
  TrackerRig vega(asking_by(PollForm::automatic));
  vega.start();
  EXPECT_EQ(vega.driver.poll_form(), PollForm::bx2);
  EXPECT_EQ(vega.driver.api_revision(), "G.003.007");
  EXPECT_EQ(vega.driver.firmware(), "orcart.001");
  TrackerRig polaris(asking_by(PollForm::automatic), {.model = NdiModel::polaris});
  polaris.start();
  EXPECT_EQ(polaris.driver.poll_form(), PollForm::bx);
  EXPECT_EQ(polaris.driver.api_revision(), "");
  EXPECT_EQ(polaris.driver.firmware(), "POLARIS Rev 024");
  EXPECT_EQ(polaris.driver.baud(), 115200u) << "it refused 921600";
}

TEST(NdiDriver, AsksForFramesOnlyWhereTheLineBearsThem) {
  TrackerRig rig(asking_by(PollForm::automatic, 115200));
  rig.start();
  EXPECT_EQ(rig.driver.poll_form(), PollForm::bx);
}

TEST(NdiDriver, FallsBackToASimplerQuestionWhereADeviceDoesNotKnowTheFirst) {
  TrackerRig rig(asking_by(PollForm::bx2), {.model = NdiModel::spectra});
  rig.run_for(3s);
  EXPECT_NE(rig.driver.health(), TrackerHealth::live) << "it was told to use BX2 and nothing else";
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::device_refuses);
  TrackerRig any(asking_by(PollForm::automatic), {.model = NdiModel::spectra});
  any.start();
  EXPECT_EQ(any.driver.poll_form(), PollForm::bx);
}

TEST(NdiDriver, TellsAFrameOfBx2OnceAndNoticesAStandingOne) {
  TrackerRig rig(asking_by(PollForm::bx2), {.clock_drift_ppm = -1000});
  rig.start();
  rig.run_for(20s, [](const DriverReport& r) { EXPECT_EQ(r.health, TrackerHealth::live); });
  EXPECT_GT(rig.driver.counters().repeats, 0u) << "polls and frames have two clocks";
  const Instant now = rig.clock.now();
  rig.device.faults().add({.fault = NdiFault::frozen_frame, .from = now, .until = now + 1s});
  const Nanos took =
      time_until(rig, 1s, [](const DriverReport& r) { return r.health == TrackerHealth::lost; });
  EXPECT_LE(took, 4 * period_of(60));
  EXPECT_EQ(rig.driver.trouble(), TrackerTrouble::frame_stuck);
}

TEST(NdiDriver, TracksWiredToolsByThePortTheyArePluggedInto) {
  NdiSettings settings{
      .tools = {TrackedTool(TrackedTool::Port{.number = 2}), TrackedTool(TrackedTool::Port{.number = 1})}};
  TrackerRig rig(std::move(settings), {.model = NdiModel::aurora});
  const auto plug = [&](std::string_view part) { return simulated_tool(part, 2).memory; };
  ASSERT_TRUE(rig.device.plug_in(plug("ONE")) && rig.device.plug_in(plug("TWO")));
  rig.start();
  rig.run_for(100ms);
  for (int tool = 0; tool < 2; ++tool) {
    const ToolReading& reading = rig.driver.reply().readings()[static_cast<std::size_t>(tool)];
    EXPECT_EQ(reading.state, ToolState::seen);
    const TrueToolPose truth =
        rig.motion.pose_of(1 - tool, rig.device.device_clock().measured_at(rig.driver.reply().device_frame));
    EXPECT_LT((reading.translation_mm - truth.translation_mm).norm(), 1e-3);
  }
}

TEST(NdiDriver, TracksAWiredAndAWirelessToolTogether) {
  NdiSettings settings{.tools = {simulated_tool("SCOPE", 2), TrackedTool(TrackedTool::Port{.number = 1})}};
  TrackerRig rig(std::move(settings));
  ASSERT_TRUE(rig.device.plug_in(simulated_tool("WIRED", 1).memory));
  rig.start();
  rig.run_for(100ms);
  EXPECT_EQ(rig.driver.reply().tools[0].state, ToolState::seen);
  EXPECT_EQ(rig.driver.reply().tools[1].state, ToolState::seen);
}

TEST(NdiDriver, SaysWhichPortHasNoTool) {
  NdiSettings settings{.tools = {TrackedTool(TrackedTool::Port{.number = 3})}};
  TrackerRig rig(std::move(settings));
  ASSERT_TRUE(rig.device.plug_in(simulated_tool("ONE", 2).memory));
  rig.run_for(5s);
  EXPECT_EQ(rig.driver.trouble_sentence(), "a wired tool is not in its port for tool in port 3");
}

TEST(NdiDriver, PassesOnThatTheSensorWasBumpedUntilSomebodyHasVerified) {
  for (const PollForm form : {PollForm::tx, PollForm::bx, PollForm::bx2}) {
    TrackerRig rig(asking_by(form));
    rig.start();
    rig.run_for(100ms);
    EXPECT_FALSE(rig.driver.bumped());
    rig.device.faults().add({.fault = NdiFault::bump, .from = rig.clock.now()});
    rig.run_for(100ms, [](const DriverReport& r) { EXPECT_EQ(r.health, TrackerHealth::live); });
    EXPECT_TRUE(rig.driver.bumped());
    EXPECT_EQ(rig.driver.counters().restarts, 0u);
    rig.driver.forget_alerts();
    EXPECT_FALSE(rig.driver.bumped());
  }
}

TEST(NdiDriver, BeepsWhenItTracksAndWhenItIsToldToInOnePollsPlace) {
  NdiSettings settings = two_tools();
  settings.beeps_when_tracking = 2;
  TrackerRig rig(std::move(settings));
  rig.start();
  EXPECT_EQ(rig.device.beeps_heard(), 2u);
  rig.run_for(500ms);
  rig.driver.beep(3);
  rig.run_for(500ms, [](const DriverReport& r) { EXPECT_EQ(r.health, TrackerHealth::live); });
  EXPECT_EQ(rig.device.beeps_heard(), 5u);
  EXPECT_LE(rig.driver.counters().polls - rig.driver.counters().replies, 2u) << "and one may be on its way";
}

TEST(NdiDriver, FindsASlowerRateWhereTheLineCannotGoFaster) {
  TrackerRig rig(asking_by(PollForm::automatic, 921600), {.model = NdiModel::polaris});
  rig.start();
  EXPECT_EQ(rig.driver.baud(), 115200u);
  EXPECT_EQ(rig.device.baud(rig.clock.now()), 115200u);
}

}  // namespace
}  // namespace orcart::testing
