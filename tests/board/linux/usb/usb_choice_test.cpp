// The ids that are known, and which device is taken.
#include "board/linux/usb/usb_choice.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace orcart {
namespace {

const UsbDeviceId kPolaris{.vendor = 0x0403, .product = 0xDA70, .port_path = "1-2", .serial = "P6-00123"};
const UsbDeviceId kOther{.vendor = 0x23F2, .product = 0x0003, .port_path = "1-3.1", .serial = "G1-00007"};
const UsbDeviceId kPlain{.vendor = 0x0403, .product = 0x6001, .port_path = "2-1", .serial = "A700"};

std::string refusal(const std::vector<UsbDeviceId>& devices, const UsbChoice& choice) {
  const auto chosen = choose_tracker(devices, choice);
  return chosen ? "" : chosen.error().message;
}

TEST(UsbIds, KnowNdisAndPlainBridgesAndNothingElse) {
  for (const std::uint16_t product : {0xDA70, 0xDA71, 0xDA72, 0xDA73, 0xDA74})
    EXPECT_TRUE(is_ndi(0x0403, product));
  EXPECT_TRUE(is_ndi(0x23F2, 0x0003));
  EXPECT_FALSE(is_ndi(0x23F2, 0x0001));
  for (const std::uint16_t product : {0x6001, 0x6010, 0x6011, 0x6014, 0x6015}) {
    EXPECT_FALSE(is_ndi(0x0403, product));
    EXPECT_FALSE(usb_name_of(0x0403, product).empty());
  }
  EXPECT_TRUE(usb_name_of(0x046D, 0xC52B).empty());
}

TEST(UsbIds, TakeNineteenThousandTwoHundredForTheFastestOnNdisAlone) {
  EXPECT_EQ(line_rate_for(0x0403, 0xDA70, 19'200), 1'200'000u);
  EXPECT_EQ(line_rate_for(0x23F2, 0x0003, 19'200), 1'200'000u);
  EXPECT_EQ(line_rate_for(0x0403, 0x6001, 19'200), 19'200u);
  EXPECT_EQ(line_rate_for(0x0403, 0xDA70, 9'600), 9'600u);
}

TEST(UsbChoice, TakesTheOnlyTrackerWhateverElseIsPluggedIn) {
  const auto chosen = choose_tracker(std::vector{kPlain, kPolaris}, {});
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(chosen->port_path, "1-2");
}

TEST(UsbChoice, TakesAPlainBridgeOnlyWhereItIsNamed) {
  EXPECT_NE(refusal({kPlain}, {}).find("0403:6001 FTDI FT232 at port 2-1, serial number A700"),
            std::string::npos);
  EXPECT_EQ(choose_tracker(std::vector{kPlain, kPolaris}, {.serial = "A700"})->product, 0x6001);
  EXPECT_EQ(choose_tracker(std::vector{kPlain, kPolaris}, {.port_path = "2-1"})->product, 0x6001);
}

TEST(UsbChoice, RefusesToGuessBetweenTwo) {
  const std::string told = refusal({kPolaris, kOther}, {});
  EXPECT_NE(told.find("more than one"), std::string::npos) << told;
  EXPECT_NE(told.find("P6-00123"), std::string::npos) << told;
  EXPECT_EQ(choose_tracker(std::vector{kPolaris, kOther}, {.port_path = "1-3.1"})->serial, "G1-00007");
}

TEST(UsbChoice, NeedsBothToMatchWhereBothAreGiven) {
  EXPECT_NE(refusal({kPolaris}, {.serial = "P6-00123", .port_path = "1-9"}), "");
}

TEST(UsbChoice, SaysThatNothingIsThere) {
  EXPECT_NE(refusal({}, {.serial = "X"}).find("no NDI or FTDI device is plugged in"), std::string::npos);
}

}  // namespace
}  // namespace orcart
