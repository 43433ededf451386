// Letters, kerning and UTF-8.
#include "render/hud/font.hpp"

#include <numeric>
#include <string>

#include <gtest/gtest.h>

namespace orcart {
namespace {

const Font& font() {
  static const Font loaded = std::move(*Font::create(1.0));
  return loaded;
}

std::u32string code_points(std::string_view utf8) {
  std::u32string all;
  while (!utf8.empty()) all.push_back(take_code_point(utf8));
  return all;
}

TEST(Utf8, IsReadCodePointByCodePoint) {
  EXPECT_EQ(code_points("aé€\xF0\x9F\x98\x80z"), U"aé€\U0001F600z");
}

TEST(Utf8, ThatIsCutOrBrokenGivesTheReplacementSignAndGoesOn) {
  EXPECT_EQ(code_points("\xC3"), U"\xFFFD");
  EXPECT_EQ(code_points("\xE2\x82"), U"\xFFFD");
  EXPECT_EQ(code_points("\xC3z"), U"\xFFFDz");
  EXPECT_EQ(code_points("\x80\xFFz"), U"\xFFFD\xFFFDz");
}

TEST(Font, KernsCapitalsThatLeanIntoEachOther) {
  EXPECT_LT(font().kerning_px(TextStyle::headline, 'A', 'V'), -1.0F);
  EXPECT_EQ(font().kerning_px(TextStyle::headline, 'H', 'H'), 0.0F);
}

TEST(Font, MeasuresALineAsItsLettersWithKerning) {
  const float separate = font().width_px(TextStyle::fine, "A") + font().width_px(TextStyle::fine, "V");
  EXPECT_FLOAT_EQ(font().width_px(TextStyle::fine, "AV"),
                  separate + font().kerning_px(TextStyle::fine, 'A', 'V'));
  EXPECT_EQ(font().width_px(TextStyle::fine, ""), 0.0F);
}

TEST(Font, HasInkForLettersAndNoneForASpace) {
  EXPECT_GT(font().glyph(TextStyle::fine, U'g').width, 5);
  EXPECT_EQ(font().glyph(TextStyle::fine, U' ').width, 0);
  EXPECT_EQ(font().glyph(TextStyle::fine, U'\x4E2D').x, font().glyph(TextStyle::fine, U'?').x);
  const Glyph& w = font().glyph(TextStyle::strong, U'W');
  int ink = 0;
  for (int y = 0; y < w.height; ++y)
    for (int x = 0; x < w.width; ++x)
      ink += font().coverage()[static_cast<std::size_t>((w.y + y) * font().atlas_width_px() + w.x + x)] > 128;
  EXPECT_GT(ink, w.width * w.height / 5);
}

TEST(Font, GrowsWithTheScale) {
  const auto twice = Font::create(2.0);
  ASSERT_TRUE(twice.has_value());
  EXPECT_NEAR(twice->cap_height_px(TextStyle::fine), 2 * font().cap_height_px(TextStyle::fine), 2.0F);
}

}  // namespace
}  // namespace orcart
