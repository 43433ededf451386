// Replies about port handles, and the words for codes and status bits.
#include "firmware-host/tracker/ndi/port_reply.hpp"

#include <gtest/gtest.h>

#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/words.hpp"

namespace orcart::ndi {
namespace {

constexpr std::string_view kDescription = "02000000UNKNOWN     00032BBC007111000000             ";

TEST(PortHandles, AreListedWithTheirStatus) {
  const auto handles = parse_port_handles("03010010200103001");
  ASSERT_TRUE(handles);
  ASSERT_EQ(handles->count, 3u);
  EXPECT_EQ(handles->list[0].handle, 1);
  EXPECT_EQ(handles->list[2].status, 0x001);
  EXPECT_EQ(parse_port_handles("00")->count, 0u);
}

TEST(PortHandles, AreRefusedWhereverTheyAreCutShortOrGoOn) {
  constexpr std::string_view kText = "020100102001";
  for (std::size_t size = 0; size < kText.size(); ++size)
    EXPECT_FALSE(parse_port_handles(kText.substr(0, size)));
  EXPECT_FALSE(parse_port_handles("0201001020010"));
  EXPECT_FALSE(parse_port_handles("01GG001"));
  EXPECT_FALSE(parse_port_handles("FF"));
}

TEST(PortDescription, IsReadFromARealDevicesReply) {
  const auto port = parse_port_description(kDescription, kPortBasics | kPartNumber);
  ASSERT_TRUE(port);
  EXPECT_TRUE(port->occupied);
  EXPECT_EQ(port->main_type, 2);
  EXPECT_EQ(port->manufacturer, "UNKNOWN");
  EXPECT_EQ(port->serial_number, "32BBC007");
  EXPECT_EQ(port->status, 0x11);
  EXPECT_EQ(port->part_number, "1000000");
}

TEST(PortDescription, SaysThatAPortIsEmptyAndRefusesHalfOfOne) {
  EXPECT_FALSE(parse_port_description("UNOCCUPIED", kPortBasics)->occupied);
  for (std::size_t size = 0; size < kDescription.size(); ++size) {
    EXPECT_FALSE(parse_port_description(kDescription.substr(0, size), kPortBasics | kPartNumber)) << size;
  }
}

TEST(NewHandle, IsTwoHexDigitsAndNothingElse) {
  EXPECT_EQ(parse_new_handle("0A"), 0x0A);
  EXPECT_FALSE(parse_new_handle(""));
  EXPECT_FALSE(parse_new_handle("0"));
  EXPECT_FALSE(parse_new_handle("0A1"));
}

TEST(Words, TellAnErrorReplyFromOthers) {
  EXPECT_EQ(error_code("ERROR08"), 0x08);
  EXPECT_FALSE(error_code("OKAY"));
  EXPECT_FALSE(error_code("ERROR"));
  for (int code = 0; code < 256; ++code) EXPECT_FALSE(error_word(static_cast<std::uint8_t>(code)).empty());
  EXPECT_EQ(error_word(0x08), "no such port handle");
}

TEST(Words, SayTheMostBasicReasonFirst) {
  EXPECT_EQ(disabled_reason(0x31), "ready");
  EXPECT_EQ(disabled_reason(0x11), "the port is not enabled");
  EXPECT_EQ(disabled_reason(0x01), "the port is not initialised");
  EXPECT_TRUE(disabled_reason(0xFFFFFF00).starts_with("no tool"));
  EXPECT_EQ(system_status_words(0), "fine");
  EXPECT_EQ(system_status_words(0x0012), "too much environmental infra-red, hardware failure");
}

// Replies of a real Aurora and a real Polaris, 2005.
TEST(PortLocation, TellsWhereARealToolIsPluggedIn) {
  const auto aurora = ndi::parse_port_location("A3-00142100200");
  ASSERT_TRUE(aurora);
  EXPECT_TRUE(aurora->wired);
  EXPECT_EQ(aurora->port, 2);
  EXPECT_EQ(aurora->channel, 0);
  EXPECT_EQ(ndi::parse_port_location("P4-00148001005")->channel, 5);
  EXPECT_FALSE(ndi::parse_port_location("P0-00001010101")->wired == true);
}

TEST(PortLocation, IsRefusedWhereItIsNone) {
  for (const std::string_view text : {"", "UNOCCUPIED", "A3-0014210020", "A3-001421002000", "A3-0014210xx00"})
    EXPECT_FALSE(ndi::parse_port_location(text)) << text;
}

}  // namespace
}  // namespace orcart::ndi
