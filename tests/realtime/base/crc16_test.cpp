// The CRC of NDI messages against values that real devices have put on the wire.
#include "realtime/base/crc16.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace orcart {
namespace {

static_assert(crc16("INIT:") == 0xE3A5, "known at compile time");

TEST(Crc16, AgreesWithTheMessagesOfRealDevices) {
  constexpr std::array<std::pair<std::string_view, int>, 15> kMessages{{
      {"INIT:", 0xE3A5},
      {"OKAY", 0xA896},
      {"RESET", 0xBE6F},
      {"VER:0", 0x65EE},
      {"TSTART:", 0x5423},
      {"TSTOP:", 0x2C14},
      {"BX:0001", 0xC26D},
      {"BX:0801", 0x00EC},
      {"TX:0001", 0x031A},
      {"PHSR:02", 0xE17E},
      {"BEEP:1", 0x8404},
      {"PHRQ:*********1****", 0xA4C1},
      {"APIREV:", 0x443E},
      {"ERROR01", 0x6BC2},
      {"COMM:50000", 0x0048},
  }};
  for (const auto& [message, crc] : kMessages) EXPECT_EQ(crc16(message), crc) << message;
}

TEST(Crc16, OfNothingIsZero) {
  EXPECT_EQ(crc16(std::string_view{}), 0);
}

TEST(Crc16, GoesOnWhereItStopped) {
  EXPECT_EQ(crc16("AY", crc16("OK")), crc16("OKAY"));
}

TEST(Crc16, IsZeroOverAMessageFollowedByItsOwnCrc) {
  constexpr std::array kHeader{std::byte{0xC4}, std::byte{0xA5}, std::byte{0x17},
                               std::byte{0x00}, std::byte{0x22}, std::byte{0xE3}};
  EXPECT_EQ(crc16(std::span<const std::byte>{kHeader}), 0)
      << "so a body's CRC may be taken with or without its header";
}

}  // namespace
}  // namespace orcart
