// The emulated tracker, asked by hand: both command forms, life cycle of tools, replies and refusals.
#include "board/sim/ndi/ndi_emulator.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "tests/board/sim/ndi/emulated_session.hpp"

namespace orcart::testing {

std::vector<std::byte> definition_of(std::span<const std::array<float, 3>> markers_mm) {
  std::vector<std::byte> file(752);
  const auto put = [&](std::size_t at, std::uint32_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) file[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xFFu);
  };
  put(0, 0x0049444E, 4);
  put(15, 2, 1);
  put(20, 0xABCDEF01, 4);
  put(28, static_cast<std::uint32_t>(markers_mm.size()), 4);
  for (std::size_t i = 0; i < markers_mm.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(72 + 12 * i + 4 * axis, std::bit_cast<std::uint32_t>(markers_mm[i][axis]), 4);
    }
  }
  std::uint32_t sum = 0;
  for (std::size_t i = 6; i < file.size(); ++i) sum += std::to_integer<std::uint32_t>(file[i]);
  put(4, sum & 0xFFFFu, 2);
  return file;
}

namespace {

constexpr std::array<std::array<float, 3>, 3> kMarkers{{{0, 0, 0}, {50, 0, 0}, {0, 30, 0}}};

/// One tool uploaded, initialised, enabled, and tracking.
struct TrackingSession : EmulatedSession {
  TrackingSession() {
    ask("INIT:");
    handle = upload(definition_of(kMarkers));
    ask("PINIT:" + handle);
    ask("PENA:" + handle + "D");
    ask("TSTART:");
    now += 1s;
  }
  std::string handle;
};

TEST(NdiEmulator, AnswersAsARealDeviceDoesToTheByte) {
  EmulatedSession session;
  EXPECT_EQ(session.raw("INIT:E3A5\r"), "OKAYA896\r");
  EXPECT_EQ(session.raw("BEEP:18404\r"), "1D4C1\r");
  EXPECT_EQ(session.raw("PHSR:01E03E\r"), "001414\r");
}

TEST(NdiEmulator, TakesCommandsWithoutColonAndCrc) {
  EmulatedSession session;
  EXPECT_EQ(session.raw("INIT \r"), "OKAYA896\r");
  EXPECT_EQ(session.raw("INIT\r"), "OKAYA896\r");
  EXPECT_EQ(session.raw("PHRQ *********1****\r").substr(0, 2), "01");
  EXPECT_EQ(session.raw("PHSR 01\r").substr(0, 7), "0101000");
}

TEST(NdiEmulator, RefusesWithTheCodeThatFits) {
  EmulatedSession session;
  EXPECT_EQ(session.ask("PHSR:00"), "ERROR10") << "not initialised";
  session.ask("INIT:");
  EXPECT_EQ(session.raw("FOO:1234\r").substr(0, 7), "ERROR04") << "the CRC comes first";
  EXPECT_EQ(session.ask("FOO:"), "ERROR01");
  EXPECT_EQ(session.raw("INIT:E3\r").substr(0, 7), "ERROR03");
  EXPECT_EQ(session.raw(std::string(5000, 'A') + "\r").substr(0, 7), "ERROR02");
  EXPECT_EQ(session.ask("BX:0001"), "ERROR0C") << "not tracking";
  EXPECT_EQ(session.ask("PINIT:07"), "ERROR08");
  EXPECT_EQ(session.ask("COMM:90000"), "ERROR06");
  EXPECT_EQ(session.ask("GET:Param.Nothing"), "ERROR34");
  EXPECT_EQ(session.ask("SET:Features.Firmware.Version=1"), "ERROR39");
  EXPECT_EQ(session.ask("SET:Param.Data Averaging.Depth=x"), "ERROR35");
  EXPECT_EQ(session.ask("SET:Param.Data Averaging.Depth=1000"), "ERROR36");
}

TEST(NdiEmulator, TakesACommandInPiecesAndSeveralAtOnce) {
  EmulatedSession session;
  const std::string command = "INIT:E3A5\r";
  for (std::size_t i = 0; i + 1 < command.size(); ++i) EXPECT_EQ(session.raw(command.substr(i, 1)), "");
  EXPECT_EQ(session.raw("\r"), "OKAYA896\r");
  EXPECT_EQ(session.raw("BEEP 1\rBEEP 2\r"), "1D4C1\r01400\r") << "0: it still beeps";
}

TEST(NdiEmulator, LeadsAToolThroughItsLife) {
  EmulatedSession session;
  session.ask("INIT:");
  const std::string handle = session.upload(definition_of(kMarkers));
  EXPECT_EQ(handle, "01");
  EXPECT_EQ(session.ask("PHSR:02"), "0101001");
  EXPECT_EQ(session.ask("PHRQ:*********1****"), "02");
  EXPECT_EQ(session.ask("PENA:02D"), "ERROR0E") << "nothing is in it";
  EXPECT_EQ(session.ask("PHF:02"), "OKAY");
  EXPECT_EQ(session.ask("PINIT:01"), "OKAY");
  EXPECT_EQ(session.ask("PHSR:03"), "0101011");
  EXPECT_EQ(session.ask("PHINF:010001"), "02000000            000ABCDEF0111");
  EXPECT_EQ(session.ask("PENA:01X"), "ERROR09");
  EXPECT_EQ(session.ask("PENA:01D"), "OKAY");
  EXPECT_EQ(session.ask("PHSR:04"), "0101031");
  EXPECT_EQ(session.ask("PDIS:01"), "OKAY");
  EXPECT_EQ(session.ask("PHF:01"), "OKAY");
  EXPECT_EQ(session.ask("PHSR:00"), "00");
}

TEST(NdiEmulator, RefusesADamagedDefinition) {
  EmulatedSession session;
  session.ask("INIT:");
  auto definition = definition_of(kMarkers);
  definition[200] ^= std::byte{1};
  session.upload(definition);
  EXPECT_EQ(session.ask("PINIT:01"), "ERROR40");
  EXPECT_EQ(session.ask("PENA:01D"), "ERROR40");
}

// As a public ROS node starts a Vega: no PINIT, Frame and Track Frequency by IRATE, small letters.
TEST(NdiEmulator, ServesAClientThatEnablesWithoutInitialisingAndWritesSmallLetters) {
  EmulatedSession session;
  EXPECT_EQ(session.raw("init \r"), "OKAYA896\r");
  const auto definition = definition_of(kMarkers);
  EXPECT_EQ(session.raw("phrq *********1****\r").substr(0, 2), "01");
  for (std::size_t at = 0; at < 12 * 64; at += 64) {
    std::string block = "pvwr 01" + EmulatedSession::hex(at, 4);
    for (std::size_t i = at; i < at + 64; ++i)
      block += EmulatedSession::hex(i < definition.size() ? std::to_integer<unsigned>(definition[i]) : 0, 2);
    EXPECT_EQ(session.raw(block + "\r").substr(0, 4), "OKAY");
  }
  EXPECT_EQ(session.raw("pena 01D\r").substr(0, 4), "OKAY");
  const std::string described = session.raw("phinf 010001\r");
  EXPECT_EQ(described.substr(described.size() - 7, 2), "31");
  EXPECT_EQ(session.raw("irate 2\r").substr(0, 4), "OKAY");
  EXPECT_EQ(session.raw("get Param.Tracking.Track Frequency\r").substr(0, 32),
            "Param.Tracking.Track Frequency=2");
  EXPECT_EQ(session.raw("tstart \r").substr(0, 4), "OKAY");
  EXPECT_TRUE(session.raw("bx 1001\r").starts_with("\xC4\xA5"));
  EXPECT_EQ(session.ask("init:"), "OKAY") << "its CRC is of the small letters";
}

/// How many frames the emulator measures, and how many of them it reports, in a second.
struct FramesInASecond {
  std::uint32_t numbered = 0;
  int reported = 0;
};
FramesInASecond frames_in_a_second(TrackingSession& session) {
  const auto frame = [&] {
    const std::string reply = session.ask("TX:0001");
    session.now -= 1s;  // ask() waits that long
    return static_cast<std::uint32_t>(std::stoul(reply.substr(63, 8), nullptr, 16));
  };
  FramesInASecond told;
  std::uint32_t last = frame();
  const std::uint32_t first = last;
  for (int ms = 0; ms < 1000; ms += 2) {
    session.now += 2ms;
    const std::uint32_t now = frame();
    told.reported += now != last;
    last = now;
  }
  told.numbered = last - first;
  return told;
}

TEST(NdiEmulator, MeasuresAtTheRateAndReportsTheShareThatTheHostSets) {
  TrackingSession session;
  EXPECT_NEAR(frames_in_a_second(session).reported, 60, 1);
  EXPECT_NE(session.ask("GETINFO:Param.Tracking.Track Frequency").find(";1/3,1/2,1/1;"), std::string::npos);
  EXPECT_EQ(session.ask("SET:Param.Tracking.Frame Frequency=20"), "ERROR0C") << "not while it tracks";
  EXPECT_EQ(session.ask("SET:Param.Tracking.Track Frequency=0"), "OKAY");
  const FramesInASecond third = frames_in_a_second(session);
  EXPECT_NEAR(third.reported, 20, 1);
  EXPECT_NEAR(third.numbered, 60, 3);
  session.ask("TSTOP:");
  EXPECT_EQ(session.ask("SET:Param.Tracking.Track Frequency=2"), "OKAY");
  EXPECT_EQ(session.ask("SET:Param.Tracking.Frame Frequency=20"), "OKAY");
  session.ask("TSTART:");
  session.now += 1s;
  EXPECT_NEAR(frames_in_a_second(session).reported, 20, 1);
}

TEST(NdiEmulator, RunsOutOfHandles) {
  EmulatedSession session;
  session.ask("INIT:");
  for (std::size_t i = 0; i < NdiEmulator::kMaxPorts; ++i)
    EXPECT_EQ(session.ask("PHRQ:*********1****").size(), 2u);
  EXPECT_EQ(session.ask("PHRQ:*********1****"), "ERROR2D");
}

TEST(NdiEmulator, TellsPosesInTextAsHosts) {
  TrackingSession session;
  const std::string reply = session.ask("TX:0801");
  EXPECT_EQ(reply.substr(0, 55), "0101+10000+00000+00000+00000+000000+000200-150000+00000");
  EXPECT_EQ(reply.substr(55, 8), "00000031");
  EXPECT_EQ(reply.substr(reply.size() - 5), "\n0000");
  session.motion.visible = false;
  EXPECT_EQ(session.ask("TX:0001").substr(0, 19), "0101MISSING00000031");
}

TEST(NdiEmulator, NeverSendsTheLongHeader) {
  TrackingSession session;
  for (const char* command : {"BX:0801", "BX:180F", "BX2:--6d=tools --3d=all --1d=none"}) {
    const std::string reply = session.ask(command);
    EXPECT_TRUE(reply.starts_with("\xC4\xA5")) << command;
    const unsigned length = static_cast<unsigned char>(reply[2]) | static_cast<unsigned char>(reply[3]) << 8;
    EXPECT_EQ(reply.size(), length + 8u) << command;
    EXPECT_EQ(crc16(std::string_view(reply).substr(0, 6)), 0) << command;
    EXPECT_EQ(crc16(std::string_view(reply).substr(6)), 0) << command;
  }
}

TEST(NdiEmulator, TellsAFrameOnceByBx2) {
  TrackingSession session;
  session.device.faults().add({.fault = NdiFault::frozen_frame, .from = session.now});
  EXPECT_GT(session.ask("BX2:--6d=tools").size(), 60u);
  EXPECT_EQ(session.ask("BX2:--6d=tools").size(), 6u + 4u + 2u) << "no component: nothing new";
}

TEST(NdiEmulator, RestartsByABreakAndForgetsEverything) {
  TrackingSession session;
  session.device.receive_break(session.now);
  EXPECT_EQ(session.collect(399ms), "");
  EXPECT_EQ(session.collect(10ms), "RESETBE6F\r");
  EXPECT_EQ(session.ask("BX:0001"), "ERROR10");
}

TEST(NdiEmulator, TakesItsTimeOverALine) {
  EmulatedSession session({.processing_time = 300us});
  session.raw("INIT:E3A5\r");
  session.device.receive(std::as_bytes(std::span{"INIT:E3A5\r", 10}), session.now);
  // 10 bytes to the device, 9 back, ten bits each at 9600 baud.
  const Nanos wire{19 * 10 * 1'000'000'000ll / 9600};
  EXPECT_NEAR(static_cast<double>((session.device.next_event() - session.now).count()),
              static_cast<double>((wire + 300us).count()), 1e3);
}

TEST(NdiEmulator, HoldsAFaultForItsWindowOnly) {
  TrackingSession session;
  session.device.faults().add(
      {.fault = NdiFault::silence, .from = session.now, .until = session.now + 500ms});
  EXPECT_EQ(session.ask("TX:0001"), "");
  EXPECT_NE(session.ask("TX:0001"), "");
}

TEST(NdiEmulator, SurvivesAnyBytes) {
  TrackingSession session;
  std::uint32_t state = 7;
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(1 + state % 40, '\0');
    for (char& byte : bytes) {
      state = state * 1664525u + 1013904223u;
      byte = static_cast<char>(state >> 24);
    }
    session.raw(bytes + '\r');
  }
  session.raw("\r");
  EXPECT_EQ(session.raw("INIT:E3A5\r"), "OKAYA896\r");
}

TEST(NdiEmulator, KnowsNoMoreThanTheModelItPlays) {
  EmulatedSession polaris({.model = NdiModel::polaris, .has_line = false});
  polaris.ask("INIT:");
  EXPECT_EQ(polaris.ask("GET:Features.Firmware.Version"), "ERROR01");
  EXPECT_EQ(polaris.ask("APIREV:"), "ERROR01");
  EXPECT_EQ(polaris.ask("BX2:--6d=tools"), "ERROR01");
  EXPECT_EQ(polaris.ask("COMM:60000"), "ERROR06") << "115200 is its fastest";
  EXPECT_TRUE(polaris.ask("VER:4").starts_with("Polaris Control Firmware"));
  EmulatedSession aurora({.model = NdiModel::aurora, .has_line = false});
  aurora.ask("INIT:");
  EXPECT_EQ(aurora.ask("PHRQ:*********1****"), "ERROR01") << "all its tools have plugs";
  EmulatedSession vega;
  EXPECT_EQ(vega.ask("APIREV:"), "G.003.007");
  EXPECT_EQ(vega.ask("GET:Features.Hardware.Model"), "Features.Hardware.Model=Polaris Vega");
}

TEST(NdiEmulator, TellsWhereAToolIsPluggedIn) {
  EmulatedSession session({.model = NdiModel::aurora, .has_line = false});
  session.device.plug_in(definition_of(kMarkers));
  session.device.plug_in(definition_of(kMarkers));
  session.ask("INIT:");
  EXPECT_EQ(session.ask("PHSR:02"),
            "0201001"
            "02001");
  EXPECT_EQ(session.ask("PHINF:020020"), "P0-00001100200");
}

TEST(NdiEmulator, SaysThatItWasBumpedUntilItIsCleared) {
  TrackingSession session;
  EXPECT_EQ(session.ask("GET:Info.Status.Bump Detected"), "Info.Status.Bump Detected=0");
  session.device.faults().add({.fault = NdiFault::bump, .from = session.now + 1ms});
  session.now += 10ms;
  const std::string reply = session.ask("TX:0001");
  EXPECT_EQ(reply.substr(reply.size() - 4), "0100") << "alerts are pending";
  EXPECT_EQ(session.ask("GET:Info.Status.New Alerts"), "Info.Status.New Alerts=2097152");
  EXPECT_EQ(session.ask("GET:Info.Status.New Alerts"), "Info.Status.New Alerts=0") << "told once";
  EXPECT_EQ(session.ask("GET:Info.Status.Bump Detected"), "Info.Status.Bump Detected=1");
  EXPECT_NE(session.ask("BX2:--6d=tools").find(std::string("\x01\x00\x02\x00", 4)), std::string::npos);
  EXPECT_EQ(session.ask("SET:Param.Bump Detector.Clear=1"), "OKAY");
  EXPECT_EQ(session.ask("GET:Info.Status.Alerts"), "Info.Status.Alerts=0");
}

TEST(NdiEmulator, SimulatesAlertsAsARealVegaDoes) {
  EmulatedSession session;
  session.ask("INIT:");
  EXPECT_EQ(session.ask("SET:Param.Simulated Alerts=16"), "OKAY");
  EXPECT_EQ(session.ask("GET:Info.Status.Alerts"), "Info.Status.Alerts=16");
  EXPECT_TRUE(session.ask("GETINFO:Param.Simulated Alerts").starts_with("Param.Simulated Alerts=16;1;2;0;"));
}

TEST(NdiEmulator, SaysThatAPortHasLostItsToolUntilPortsAreListed) {
  TrackingSession session;
  session.device.faults().add({.fault = NdiFault::unplugged, .from = session.now, .amount = 0});
  session.ask("TX:0001");
  const std::string reply = session.ask("TX:0001");
  EXPECT_EQ(reply.substr(reply.size() - 4), "0080");
  session.ask("PHSR:00");
  const std::string after = session.ask("TX:0001");
  EXPECT_EQ(after.substr(after.size() - 4), "0000");
}

}  // namespace
}  // namespace orcart::testing
