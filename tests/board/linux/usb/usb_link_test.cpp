// The USB tracker's link against a scripted bridge: the ByteLink contract, FTDI's order, faults, and that
// nothing leaks.
#include "board/linux/usb/usb_link.hpp"

#include <gtest/gtest.h>

#include "tests/board/linux/usb/scripted_usb.hpp"
#include "tests/board/ports/byte_link_contract.hpp"

namespace orcart::testing {

class UsbRig final : public ByteLinkRig {
 public:
  UsbRig() : link_(UsbLink::open(std::make_unique<ScriptedBus>(script), {}).value()) {}
  ~UsbRig() override {
    link_.reset();
    EXPECT_EQ(script.opened, script.closed) << "a device was left open";
    EXPECT_EQ(script.still_in_flight_at_close, 0);
  }
  Clock& clock() override { return clock_; }
  ByteLink& link() override { return *link_; }
  UsbLink& usb() { return *link_; }
  void cut() override { script.unplug(); }
  bool mend() override {
    script.plug_in();
    return true;
  }
  ScriptedUsb script;

 private:
  RealClock clock_;
  std::unique_ptr<UsbLink> link_;
};

INSTANTIATE_TYPED_TEST_SUITE_P(Usb, ByteLinkContract, UsbRig);

namespace {

std::string read_all(UsbLink& link, std::size_t count) {
  RealClock clock;
  const Instant end = clock.now() + 2s;
  std::string text;
  std::array<std::byte, 700> piece{};
  while (text.size() < count && clock.now() < end) {
    link.wait(end);
    const auto got = link.read(piece);
    if (!got) break;
    for (std::size_t i = 0; i < *got; ++i) text += static_cast<char>(piece[i]);
  }
  return text;
}

Result<void, PortFault> say(UsbLink& link, std::string_view text) {
  return link.write(std::as_bytes(std::span{text.data(), text.size()}));
}

TEST(UsbLink, TellsTheChipEverythingBeforeTheFirstByte) {
  UsbRig rig;
  const ftdi::Chip chip;
  EXPECT_EQ(rig.script.requests,
            (std::vector{ftdi::reset(chip), ftdi::purge_receive(chip), ftdi::purge_transmit(chip),
                         ftdi::set_latency_timer(chip, 1), ftdi::set_data(chip, ftdi::Break::off),
                         ftdi::set_flow(chip, FlowControl::none), ftdi::raise_modem_lines(chip),
                         *ftdi::set_baud(chip, 9600)}));
}

TEST(UsbLink, SetsRateAndFlowAndBreaksTheLine) {
  UsbRig rig;
  rig.script.requests.clear();
  ASSERT_TRUE(rig.usb().set_line({.baud = 1'228'739, .flow = FlowControl::hardware}));
  ASSERT_TRUE(rig.usb().set_line({.baud = 19'200}));
  ASSERT_TRUE(rig.usb().send_break());
  EXPECT_EQ(rig.script.requests,
            (std::vector<ftdi::Request>{
                {3, 0x4002, 0}, {2, 0, 0x0100}, {3, 0x4002, 0}, {2, 0, 0}, {4, 0x4008, 0}, {4, 0x0008, 0}}));
  EXPECT_EQ(rig.usb().set_line({.baud = 4'000'000}).error(), PortFault::unsupported);
}

TEST(UsbLink, StripsTheStatusOfEveryPacketOfALongReply) {
  UsbRig rig;
  std::string text;
  for (int i = 0; i < 400; ++i) text += static_cast<char>('a' + i % 26);
  rig.script.send(text);
  EXPECT_EQ(read_all(rig.usb(), text.size()), text);
}

TEST(UsbLink, SleepsThroughPacketsThatHoldNothingButTheirStatus) {
  UsbRig rig;
  rig.script.send("");
  rig.script.send("");
  std::array<std::byte, 8> into{};
  rig.usb().wait(rig.clock().now() + 20ms);
  EXPECT_EQ(rig.usb().read(into).value_or(99), 0u);
  rig.script.send("x", 0x62);
  EXPECT_EQ(read_all(rig.usb(), 1), "x");
  EXPECT_EQ(rig.usb().figures().line.overruns, 1u);
}

TEST(UsbLink, SurvivesSingleErrorsOnTheBus) {
  UsbRig rig;
  rig.script.fail_in();
  rig.script.send("still here");
  EXPECT_EQ(read_all(rig.usb(), 10), "still here");
  EXPECT_EQ(rig.usb().figures().failed_transfers, 1u);
}

TEST(UsbLink, TakesAnEndlessRowOfErrorsForAPulledPlug) {
  UsbRig rig;
  for (int i = 0; i < 10; ++i) rig.script.fail_in();
  const Instant end = rig.clock().now() + 2s;
  std::array<std::byte, 8> into{};
  auto got = rig.usb().read(into);
  while (got && rig.clock().now() < end) {
    rig.usb().wait(end);
    got = rig.usb().read(into);
  }
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error(), PortFault::disconnected);
}

TEST(UsbLink, HandsOutWhatCameBeforeThePlugWasPulled) {
  UsbRig rig;
  rig.script.send("last words");
  RealClock clock;
  rig.usb().wait(clock.now() + 1s);
  rig.script.unplug();
  EXPECT_EQ(read_all(rig.usb(), 10), "last words");
  std::array<std::byte, 8> into{};
  rig.usb().wait(clock.now() + 1s);
  EXPECT_FALSE(rig.usb().read(into));
  EXPECT_EQ(rig.script.closed, 1) << "closed as soon as the fault was read";
}

TEST(UsbLink, RefusesToSendMoreThanItsTransfersHold) {
  UsbRig rig;
  rig.script.swallow_out = true;
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(say(rig.usb(), "BEEP:18404\r"));
  EXPECT_EQ(say(rig.usb(), "BEEP:18404\r").error(), PortFault::timed_out);
  EXPECT_FALSE(say(rig.usb(), std::string(513, 'x')));
}

TEST(UsbLink, OpensAndClosesAHundredTimesWithoutALeak) {
  ScriptedUsb script;
  for (int i = 0; i < 100; ++i) {
    auto link = UsbLink::open(std::make_unique<ScriptedBus>(script), {.serial = "P6-1"});
    ASSERT_TRUE(link);
    ASSERT_TRUE(say(**link, "INIT:E3A5\r"));
    EXPECT_EQ(read_all(**link, 9), "OKAYA896\r");
  }
  EXPECT_EQ(script.opened, 100);
  EXPECT_EQ(script.closed, 100);
  EXPECT_EQ(script.still_in_flight_at_close, 0);
}

TEST(UsbLink, LeavesNothingOpenWhereverOpeningFails) {
  for (int at = 0; at < 8; ++at) {
    ScriptedUsb script;
    script.fail_control_at = at;
    EXPECT_FALSE(UsbLink::open(std::make_unique<ScriptedBus>(script), {}));
    EXPECT_EQ(script.opened, 1);
    EXPECT_EQ(script.closed, 1);
  }
  for (int at = 0; at < 8; ++at) {
    ScriptedUsb script;
    script.fail_prepare_at = at;
    EXPECT_FALSE(UsbLink::open(std::make_unique<ScriptedBus>(script), {}));
    EXPECT_EQ(script.closed, 1);
  }
}

TEST(UsbLink, SaysInASentenceWhyItCannotBeOpened) {
  ScriptedUsb script;
  script.open_fault = PortFault::no_permission;
  const auto refused = UsbLink::open(std::make_unique<ScriptedBus>(script), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().message,
      "USB tracker 0403:DA70 NDI Host USB Converter at port 1-1, serial number P6-1 cannot be opened: no "
      "permission; a udev rule that lets this user in is wanted (board/cart has one)");
  script.unplug();
  const auto absent = UsbLink::open(std::make_unique<ScriptedBus>(script), {});
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message.find("no NDI or FTDI device is plugged in"), std::string::npos);
}

}  // namespace
}  // namespace orcart::testing
