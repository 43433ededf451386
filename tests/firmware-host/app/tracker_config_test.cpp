// [tracker]: each kind has its own keys, and its link is opened or refused in a sentence.
#include "firmware-host/app/tracker_config.hpp"

#include <gtest/gtest.h>

#include "firmware-host/app/open_tracker.hpp"
#include "realtime/kernel/clock.hpp"
#include "tests/firmware-host/app/demo_cart.hpp"

namespace orcart::testing {
namespace {

std::filesystem::path here() {
  return demo_cart().parent_path() / "cart.toml";
}
constexpr std::string_view kTools =
    "scope_rom = \"../tools/scope.rom\"\nreference_rom = \"../tools/reference.rom\"\n";

Result<TrackerConfig> read(const std::string& keys) {
  auto reader = TomlReader::parse("[tracker]\n" + keys + std::string(kTools), here());
  if (!reader) return tl::unexpected(reader.error());
  TrackerConfig tracker;
  read_tracker((*reader)->section("tracker"), tracker);
  if (auto finished = (*reader)->finish(); !finished) return tl::unexpected(finished.error());
  return tracker;
}

std::string complaint(const std::string& keys) {
  const auto tracker = read(keys);
  return tracker ? std::string{} : tracker.error().message;
}

bool tells(const std::string& complaint, const std::string& what) {
  return complaint.find(what) != std::string::npos;
}

TEST(TrackerConfig, ReadsASerialTracker) {
  const auto tracker =
      read("kind = \"tty\"\ndevice = \"/dev/ttyUSB3\"\nbaud = 921600\nflow = \"hardware\"\n");
  ASSERT_TRUE(tracker) << tracker.error().message;
  EXPECT_EQ(tracker->device, "/dev/ttyUSB3");
  EXPECT_EQ(tracker->baud, 921600u);
  EXPECT_EQ(tracker->flow, FlowControl::hardware);
  EXPECT_TRUE(is_device(tracker->kind));
}

TEST(TrackerConfig, ReadsANetworkTrackerWhichHasNoLine) {
  const auto tracker = read("kind = \"tcp\"\nhost = \"169.254.9.239\"\n");
  ASSERT_TRUE(tracker) << tracker.error().message;
  EXPECT_EQ(tracker->port, 8765);
  EXPECT_EQ(tracker->baud, 0u);
  EXPECT_TRUE(tells(complaint("kind = \"tcp\"\nhost = \"vega\"\nbaud = 115200\n"), "baud"));
}

TEST(TrackerConfig, ReadsAUsbTrackerByItsSerialNumberOrPort) {
  const auto any = read("kind = \"usb\"\nbaud = 1228739\n");
  ASSERT_TRUE(any) << any.error().message;
  EXPECT_TRUE(any->usb_serial.empty() && any->usb_port.empty());
  const auto one = read("kind = \"usb\"\nserial = \"P6-00123\"\nport = \"1-2.3\"\n");
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->usb_serial, "P6-00123");
  EXPECT_EQ(one->usb_port, "1-2.3");
  EXPECT_TRUE(tells(complaint("kind = \"usb\"\nbaud = 19200\n"), "1.2 Mbaud"));
}

TEST(TrackerConfig, RefusesTheKeysOfAnotherKind) {
  EXPECT_TRUE(tells(complaint("kind = \"tty\"\ndevice = \"/dev/ttyUSB0\"\nhost = \"vega\"\n"), "host"));
  EXPECT_TRUE(tells(complaint("kind = \"tcp\"\n"), "host"));
  EXPECT_TRUE(tells(complaint("kind = \"tty\"\n"), "device"));
  EXPECT_TRUE(tells(complaint("kind = \"carrier pigeon\"\n"), "replay"));
}

TEST(TrackerConfig, RefusesABaudThatNoDeviceHas) {
  const std::string told = complaint("kind = \"tty\"\ndevice = \"/dev/ttyUSB0\"\nbaud = 460800\n");
  EXPECT_TRUE(tells(told, "460800") || tells(told, "230400")) << told;
}

TEST(TrackerConfig, MakesSettingsOfBothTools) {
  const auto tracker = read("kind = \"simulated\"\n");
  ASSERT_TRUE(tracker) << tracker.error().message;
  const auto settings = settings_of(*tracker);
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(settings->tools.size(), 2u);
}

TEST(TrackerConfig, TakesAToolByItsPortInsteadOfItsDefinition) {
  auto reader = TomlReader::parse(
      "[tracker]\nkind = \"usb\"\npoll = \"bx\"\nbeeps = 2\nscope_port = 2\nscope_channel = "
      "1\nreference_port = 3\n",
      here());
  ASSERT_TRUE(reader);
  TrackerConfig tracker;
  read_tracker((*reader)->section("tracker"), tracker);
  ASSERT_TRUE((*reader)->finish());
  const auto settings = settings_of(tracker);
  ASSERT_TRUE(settings) << settings.error().message;
  ASSERT_EQ(settings->tools.size(), 2u);
  EXPECT_EQ(settings->tools[0].wired->number, 2);
  EXPECT_EQ(settings->tools[0].wired->channel, 1);
  EXPECT_EQ(settings->tools[1].name(), "in port 3");
  EXPECT_EQ(settings->poll, PollForm::bx);
  EXPECT_EQ(settings->beeps_when_tracking, 2);
  EXPECT_TRUE(tells(complaint("kind = \"usb\"\nscope_port = 2\n"), "either wireless or plugged in"));
}

TEST(TrackerConfig, RefusesOneToolUnderTwoNames) {
  TrackerConfig ports{.kind = TrackerKind::usb, .scope_port = {.number = 2}, .reference_port = {.number = 2}};
  ASSERT_FALSE(settings_of(ports));
  EXPECT_EQ(
      settings_of(ports).error().message,
      "[tracker] scope_port and reference_port name the same tool (in port 2); each wants one of its own");
  ports.reference_port.channel = 1;
  EXPECT_TRUE(settings_of(ports));
  const auto tools = here().parent_path().parent_path() / "tools";
  TrackerConfig roms{.scope_rom = tools / "scope.rom", .reference_rom = tools / "reference.rom"};
  EXPECT_TRUE(settings_of(roms)) << settings_of(roms).error().message;
  roms.second = true;
  roms.second_rom = roms.reference_rom;
  ASSERT_FALSE(settings_of(roms));
  EXPECT_TRUE(tells(settings_of(roms).error().message, "reference_rom and second_rom name the same tool"));
}

TEST(OpenTracker, HasNothingToOpenForASimulatedOne) {
  SimulatedClock clock;
  const auto link = open_tracker({}, clock);
  ASSERT_TRUE(link);
  EXPECT_EQ(*link, nullptr);
}

TEST(OpenTracker, SaysWhatCannotBeOpenedAndWhatWould) {
  SimulatedClock clock;
  const auto tty = open_tracker({.kind = TrackerKind::tty, .device = "/dev/nowhere"}, clock);
  ASSERT_FALSE(tty);
  EXPECT_TRUE(tells(tty.error().message, "/dev/nowhere"));
  const auto replay = open_tracker({.kind = TrackerKind::replay, .dialogue = "/nowhere/talk.txt"}, clock);
  ASSERT_FALSE(replay);
  EXPECT_TRUE(tells(replay.error().message, "/nowhere/talk.txt"));
  const auto tcp = open_tracker({.kind = TrackerKind::tcp, .host = "127.0.0.1", .port = 1}, clock);
  ASSERT_FALSE(tcp);
  EXPECT_TRUE(tells(tcp.error().message, "127.0.0.1:1")) << tcp.error().message;
}

}  // namespace
}  // namespace orcart::testing
