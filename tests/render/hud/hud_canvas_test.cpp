// Pixels that letters and shapes cover.
#include "render/hud/hud_canvas.hpp"

#include <gtest/gtest.h>

#include "tests/render/support/offscreen.hpp"

namespace orcart {
namespace {

using testing::Offscreen;
using testing::Pixels;

constexpr Colour kRed{255, 0, 0, 255};

class HudCanvasTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 320, kHeight = 200;
  HudCanvasTest() { target_.clear(0, 0, 0); }
  HudCanvas canvas() {
    auto made = HudCanvas::create({.width_px = kWidth, .height_px = kHeight});
    EXPECT_TRUE(made.has_value()) << made.error().message;
    return std::move(*made);
  }
  static int ink(const Pixels& p, int x0, int y0, int x1, int y1) {
    int count = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) count += p.at(x, y)[0] > 128;
    return count;
  }
  Offscreen target_{kWidth, kHeight};
};

TEST_F(HudCanvasTest, FillsABoxToItsEdgesAndNotBeyond) {
  HudCanvas c = canvas();
  c.box({10, 20, 30, 40}, 0, kRed);
  c.flush();
  const Pixels p = target_.read();
  EXPECT_EQ(ink(p, 0, 0, kWidth, kHeight), 30 * 40);
  EXPECT_EQ(ink(p, 10, 20, 40, 60), 30 * 40);
}

TEST_F(HudCanvasTest, LeavesTheInsideOfARingClear) {
  HudCanvas c = canvas();
  c.ring({100, 100}, 40, 4, kRed);
  c.flush();
  const Pixels p = target_.read();
  EXPECT_EQ(p.at(100, 100)[0], 0);
  EXPECT_GT(p.at(138, 100)[0], 200);
  EXPECT_EQ(p.at(142, 100)[0], 0);
}

TEST_F(HudCanvasTest, WritesTextOverItsBaseLineWithinItsWidth) {
  HudCanvas c = canvas();
  const float end = c.text({20, 100}, TextStyle::headline, kRed, "HE");
  c.flush();
  const Pixels p = target_.read();
  const int top = 100 - static_cast<int>(c.font().cap_height_px(TextStyle::headline));
  EXPECT_GT(ink(p, 20, top, static_cast<int>(end), 100), 20);
  EXPECT_EQ(ink(p, 20, top, static_cast<int>(end), 100), ink(p, 0, 0, kWidth, kHeight));
}

TEST_F(HudCanvasTest, EndsALineWhereItIsTold) {
  HudCanvas c = canvas();
  c.text_ending({300, 100}, TextStyle::headline, kRed, "H");
  c.flush();
  const Pixels p = target_.read();
  EXPECT_GT(ink(p, 290 - 10, 60, 300, 101), 10);
  EXPECT_EQ(ink(p, 300, 0, kWidth, kHeight), 0);
}

TEST_F(HudCanvasTest, DrawsAStrokeAlongItsTwoEndsAndBreaksADashedOne) {
  HudCanvas c = canvas();
  c.stroke({.from = {20, 30}, .to = {120, 130}, .width_px = 4}, kRed);
  c.stroke({.from = {20, 150}, .to = {120, 150}, .width_px = 4, .dash_px = 10}, kRed);
  c.flush();
  const Pixels p = target_.read();
  EXPECT_GT(p.at(70, 80)[0], 200);
  EXPECT_EQ(p.at(80, 70)[0], 0);
  EXPECT_GT(p.at(25, 150)[0], 200);
  EXPECT_EQ(p.at(35, 150)[0], 0);
  EXPECT_GT(p.at(45, 150)[0], 200);
}

TEST_F(HudCanvasTest, LeavesOutWhatDoesNotFitAnyMoreAndStartsAfreshAfterwards) {
  HudCanvas c = canvas();
  for (int i = 0; i < 5000; ++i) c.box({0, 0, 1, 1}, 0, {0, 0, 0, 0});
  c.box({50, 50, 10, 10}, 0, kRed);
  c.flush();
  EXPECT_EQ(target_.read().at(55, 55)[0], 0);
  c.box({50, 50, 10, 10}, 0, kRed);
  c.flush();
  EXPECT_EQ(target_.read().at(55, 55)[0], 255);
}

TEST_F(HudCanvasTest, BlendsByTheColoursOwnCoverage) {
  target_.clear(1, 1, 1);
  HudCanvas c = canvas();
  c.box({0, 0, 50, 50}, 0, {0, 0, 0, 128});
  c.flush();
  EXPECT_NEAR(target_.read().at(25, 25)[0], 127, 1);
}

}  // namespace
}  // namespace orcart
