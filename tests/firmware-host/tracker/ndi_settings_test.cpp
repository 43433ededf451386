// Tracker settings: what cannot work is refused before anything is opened.
#include "firmware-host/tracker/ndi_settings.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/tracker/tracker_rig.hpp"

namespace orcart::testing {
namespace {

std::string refusal(const NdiSettings& settings) {
  const auto checked = check(settings);
  return checked ? "" : checked.error().message;
}

TEST(NdiSettings, AcceptTwoToolsAtSixtyHertz) {
  EXPECT_EQ(refusal(two_tools()), "");
}

TEST(NdiSettings, RefuseARateThatDoesNotFitTheLine) {
  // 12 bytes asked, 11 + 2 * 42 answered: 107 bytes, 111.5 ms at 9600 baud; 0.9 / 0.1115 s = 8.07 Hz.
  EXPECT_EQ(
      refusal(two_tools(9600)),
      "tracker poll rate 60 Hz does not fit: a poll of 2 tools takes 111.458 ms at 9600 baud; at most 8 Hz "
      "would be accepted");
  NdiSettings slow = two_tools(9600);
  slow.poll_rate_hz = 8;
  EXPECT_EQ(refusal(slow), "");
}

TEST(NdiSettings, RefuseRatesBaudsAndToolCountsThatDoNotExist) {
  NdiSettings settings = two_tools(460800);
  EXPECT_NE(refusal(settings).find("tracker baud 460800 is none that NDI devices have"), std::string::npos);
  settings = two_tools(0);
  settings.poll_rate_hz = 1000;
  EXPECT_NE(refusal(settings).find("1 to 400 would be accepted"), std::string::npos);
  settings.tools.clear();
  EXPECT_NE(refusal(settings).find("tracker has 0 tools; 1 to 8"), std::string::npos);
}

}  // namespace
}  // namespace orcart::testing
