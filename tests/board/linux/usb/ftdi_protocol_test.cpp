// Divisors, requests and the status bytes of every packet, against numbers seen on the wire and in data
// sheets.
#include "board/linux/usb/ftdi_protocol.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace orcart::ftdi {
namespace {

constexpr Chip kFullSpeed{};
constexpr Chip kHighSpeed{.base = ClockBase::mhz12, .channel = 1};

std::vector<std::byte> bytes_of(const std::vector<int>& values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST(FtdiBaud, HasTheDivisorsOfTheDataSheet) {
  // FT232B: 9600 is 312.5, 19200 is 156.25, 38400 is 78.125, 115200 is 26.0, 230400 is 13.0, 921600 is 3.25.
  EXPECT_EQ(set_baud(kFullSpeed, 9600), (Request{3, 0x4138, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 19200), (Request{3, 0x809C, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 38400), (Request{3, 0xC04E, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 115200), (Request{3, 0x001A, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 230400), (Request{3, 0x000D, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 921600), (Request{3, 0x8003, 0}));
}

TEST(FtdiBaud, PutsTheThirdBitOfTheFractionIntoTheIndex) {
  // 14400 is 208.333, nearest 208.375; 57600 is 52.083, nearest 52.125: code 3, both low bits in the value.
  EXPECT_EQ(set_baud(kFullSpeed, 57600), (Request{3, 0xC034, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 14400), (Request{3, 0x00D0, 1}));
}

TEST(FtdiBaud, GivesNdisFastestRateTheDivisorTwoAndAHalf) {
  EXPECT_EQ(set_baud(kFullSpeed, 1'228'739), (Request{3, 0x4002, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 1'200'000), (Request{3, 0x4002, 0}));
  EXPECT_DOUBLE_EQ(rate_of(kFullSpeed, 1'228'739), 1.2e6);
}

TEST(FtdiBaud, KnowsTheTwoRatesWithCodesOfTheirOwn) {
  EXPECT_EQ(set_baud(kFullSpeed, 3'000'000), (Request{3, 0, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 2'000'000), (Request{3, 1, 0}));
  EXPECT_EQ(set_baud(kFullSpeed, 1'500'000), (Request{3, 2, 0}));
}

TEST(FtdiBaud, UsesTheFasterClockOfHighSpeedChipsAndNamesTheChannel) {
  // 12 MHz / 115200 is 104.17, nearest 104.125: code 3. The flag of the clock is bit 17.
  EXPECT_EQ(set_baud(kHighSpeed, 115200), (Request{3, 0xC068, 0x0201}));
  EXPECT_EQ(clock_base_of(0x0900), ClockBase::mhz12);
  EXPECT_EQ(clock_base_of(0x0600), ClockBase::mhz3);
  EXPECT_EQ(clock_base_of(0x0400), ClockBase::mhz3);
}

TEST(FtdiBaud, RefusesWhatNoDivisorReaches) {
  for (const std::uint32_t baud : {0u, 1u, 182u, 4'000'000u}) {
    EXPECT_EQ(set_baud(kFullSpeed, baud), std::nullopt) << baud;
    EXPECT_EQ(rate_of(kFullSpeed, baud), 0) << baud;
  }
}

TEST(FtdiBaud, StaysWithinThreePercentOfEveryRateOfNdis) {
  for (const std::uint32_t baud :
       {9600u, 14400u, 19200u, 38400u, 57600u, 115200u, 230400u, 921600u, 1228739u}) {
    for (const Chip& chip : {kFullSpeed, kHighSpeed})
      EXPECT_NEAR(rate_of(chip, baud) / baud, 1.0, 0.025) << baud;
  }
}

TEST(FtdiRequests, SayWhatTheLinuxDriverSays) {
  EXPECT_EQ(reset(kFullSpeed), (Request{0, 0, 0}));
  EXPECT_EQ(purge_receive(kFullSpeed), (Request{0, 1, 0}));
  EXPECT_EQ(purge_transmit(kHighSpeed), (Request{0, 2, 1}));
  EXPECT_EQ(raise_modem_lines(kFullSpeed), (Request{1, 0x0303, 0}));
  EXPECT_EQ(set_flow(kFullSpeed, FlowControl::none), (Request{2, 0, 0}));
  EXPECT_EQ(set_flow(kHighSpeed, FlowControl::hardware), (Request{2, 0, 0x0101}));
  EXPECT_EQ(set_data(kFullSpeed, Break::off), (Request{4, 0x0008, 0}));
  EXPECT_EQ(set_data(kFullSpeed, Break::on), (Request{4, 0x4008, 0}));
  EXPECT_EQ(set_latency_timer(kFullSpeed, 1), (Request{9, 1, 0}));
  EXPECT_EQ(set_latency_timer(kFullSpeed, 0), (Request{9, 1, 0}));
}

struct Stripped {
  std::string text;
  LineErrors errors;
};

Stripped strip(const std::vector<std::byte>& transfer, std::size_t packet, std::size_t room = 1024) {
  Stripped result;
  std::vector<std::byte> into(room);
  const std::size_t count = strip_status(transfer, packet, into, result.errors);
  for (std::size_t i = 0; i < count; ++i) result.text += static_cast<char>(into[i]);
  return result;
}

TEST(FtdiPackets, LoseTheTwoStatusBytesOfEveryPacketAndNotOnlyTheFirst) {
  std::vector<int> values{1,   0x60, 'a', 'b', 'c', 'd', 'e', 'f',  1,  0x60,
                          'g', 'h',  'i', 'j', 'k', 'l', 1,   0x60, 'm'};
  EXPECT_EQ(strip(bytes_of(values), 8).text, "abcdefghijklm");
}

TEST(FtdiPackets, MayHoldNothingButTheirStatus) {
  EXPECT_EQ(strip(bytes_of({1, 0x60}), 64).text, "");
  EXPECT_EQ(strip({}, 64).text, "");
  EXPECT_EQ(strip(bytes_of({1}), 64).text, "");
  EXPECT_EQ(strip(bytes_of({1, 0x60, 'x', 'y', 1, 0x60}), 4).text, "xy");
}

TEST(FtdiPackets, CountWhatTheStatusSaysOfTheLine) {
  const auto stripped = strip(bytes_of({1, 0x62, 'x', 1, 0x6C, 'y', 1, 0x70, 'z'}), 3);
  EXPECT_EQ(stripped.text, "xyz");
  EXPECT_EQ(stripped.errors.overruns, 1u);
  EXPECT_EQ(stripped.errors.parity, 1u);
  EXPECT_EQ(stripped.errors.framing, 1u);
  EXPECT_EQ(stripped.errors.breaks, 1u);
}

TEST(FtdiPackets, NeverWriteMoreThanThereIsRoomFor) {
  EXPECT_EQ(strip(bytes_of({1, 0x60, 'a', 'b', 'c', 'd'}), 64, 3).text, "abc");
  EXPECT_EQ(strip(bytes_of({1, 0x60, 'a', 'b'}), 0, 1).text, "a") << "a packet size that does not exist";
}

}  // namespace
}  // namespace orcart::ftdi
