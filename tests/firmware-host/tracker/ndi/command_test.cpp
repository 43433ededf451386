// Commands as they stand in recordings of real hosts.
#include "firmware-host/tracker/ndi/command.hpp"

#include <gtest/gtest.h>

#include <string>

#include "firmware-host/tracker/ndi/baud.hpp"

namespace orcart::ndi {
namespace {

TEST(Command, IsSpeltAsHostsSpellIt) {
  EXPECT_EQ(initialise().text(), "INIT:E3A5\r");
  EXPECT_EQ(set_line('5', false).text(), "COMM:500000048\r");
  EXPECT_EQ(request_wireless_handle().text(), "PHRQ:*********1****A4C1\r");
  EXPECT_EQ(search_ports(PortSearch::uninitialised).text(), "PHSR:02E17E\r");
  EXPECT_EQ(initialise_port(1).text(), "PINIT:0131EA\r");
  EXPECT_EQ(enable_port(1, TrackingPriority::moving).text(), "PENA:01D6D3B\r");
  EXPECT_EQ(free_port(3).text(), "PHF:030E8D\r");
  EXPECT_EQ(describe_port(1, 0x21).text(), "PHINF:010021AFAD\r");
  EXPECT_EQ(start_tracking().text(), "TSTART:5423\r");
  EXPECT_EQ(poll_binary(0x0801).text(), "BX:080100EC\r");
  EXPECT_EQ(poll_binary(0x0801).reply_kind(), ReplyKind::binary);
}

TEST(Command, CarriesABlockOfAToolDefinition) {
  std::array<std::byte, kRomBlockBytes> block{};
  EXPECT_EQ(write_rom(1, 2, block).text(), "PVWR:010080" + std::string(128, '0') + "ADDC\r");
}

TEST(Command, ThatDoesNotFitIsEmpty) {
  EXPECT_TRUE(Command("PVWR", std::string(200, '0')).text().empty());
}

TEST(WireTime, IsTenBitsAByte) {
  EXPECT_EQ(wire_time(96, 9600), 100ms);
  EXPECT_EQ(wire_time(0, 9600), 0ns);
  EXPECT_EQ(wire_time(1000, 0), 0ns) << "a network has no line";
}

TEST(Baud, GoesDownTheTableToItsEnd) {
  EXPECT_EQ(code_of_baud(230400), 'A');
  EXPECT_FALSE(code_of_baud(460800));
  EXPECT_EQ(next_slower(921600), 230400u);
  EXPECT_FALSE(next_slower(9600));
}

}  // namespace
}  // namespace orcart::ndi
