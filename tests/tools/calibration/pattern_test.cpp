// What may be typed for a pattern.
#include "tools/calibration/pattern.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(Pattern, IsReadAndWrittenBack) {
  for (const char* text : {"chessboard:14x10:3mm", "charuco:19x26:5mm:4mm:4X4_250",
                           "charuco:19x26:5mm:4mm:4X4_250:legacy", "dots:16x14:4mm"}) {
    const auto pattern = parse_pattern(text);
    ASSERT_TRUE(pattern) << text;
    EXPECT_EQ(text_of(*pattern), text);
  }
  EXPECT_EQ(parse_pattern("charuco:19x26:5mm:4mm:4X4_250")->corner_columns(), 18);
}

TEST(Pattern, RefusesWithThePartThatIsWrong) {
  for (const char* text : {"", "chess:14x10:3mm", "chessboard:14:3mm", "chessboard:14x10:3",
                           "chessboard:14x10:0.003m", "chessboard:2x10:3mm", "charuco:19x26:5mm:6mm:4X4_250",
                           "charuco:19x26:5mm:4mm:4X4_250:old", "dots:16x14:4mm:x", "dots:16x14:-4mm"})
    EXPECT_FALSE(parse_pattern(text)) << text;
  EXPECT_NE(parse_pattern("chessboard:14x10:3").error().message.find("\"3\" is no length in mm"),
            std::string::npos);
}

}  // namespace
}  // namespace orcart
