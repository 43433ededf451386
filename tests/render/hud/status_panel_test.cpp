// Each state is on the panel as a word and a colour.
#include "render/hud/status_panel.hpp"

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/render/support/offscreen.hpp"

namespace orcart {
namespace {

using testing::Offscreen;
using testing::Pixels;

constexpr int kWidth = 1280, kHeight = 800;
const Status kAllWell{.video = Freshness::live,
                      .tracker = Freshness::live,
                      .tool_seen = true,
                      .reference_seen = true,
                      .captures = 12,
                      .coverage = 0.431F,
                      .latency_ms = 17.3F,
                      .rendered_hz = 30};

Pixels drawn(const Status& status, InsetContent inset = InsetContent::picture, int width = kWidth,
             int height = kHeight) {
  Offscreen target(width, height);
  target.clear(0.06F, 0.07F, 0.08F);
  auto canvas = HudCanvas::create({.width_px = width, .height_px = height});
  EXPECT_TRUE(canvas.has_value());
  const PanelLayout layout = panel_layout(width, height);
  draw_column_and_bar(*canvas, layout, status, inset);
  draw_banners(*canvas, layout, status);
  canvas->flush();
  return target.read();
}

/// How many pixels of a part of the panel are close to a colour.
int pixels_like(const Pixels& p, const HudBox& part, std::array<int, 3> colour) {
  int count = 0;
  for (int y = static_cast<int>(part.y); y < static_cast<int>(part.y + part.height); ++y) {
    for (int x = static_cast<int>(part.x); x < static_cast<int>(part.x + part.width); ++x) {
      const auto at = p.at(x, y);
      count += std::abs(at[0] - colour[0]) < 20 && std::abs(at[1] - colour[1]) < 20 &&
               std::abs(at[2] - colour[2]) < 20;
    }
  }
  return count;
}

constexpr std::array<int, 3> kGreen{98, 200, 132}, kAmber{244, 185, 66}, kRed{238, 92, 82},
    kWhite{236, 236, 232};
const PanelLayout kLayout = panel_layout(kWidth, kHeight);

int difference(const Pixels& a, const Pixels& b, const HudBox& part) {
  int count = 0;
  for (int y = static_cast<int>(part.y); y < static_cast<int>(part.y + part.height); ++y)
    for (int x = static_cast<int>(part.x); x < static_cast<int>(part.x + part.width); ++x)
      count += a.at(x, y) != b.at(x, y);
  return count;
}

TEST(StatusPanel, IsGreenAndCalmWhenAllIsWell) {
  const Pixels p = drawn(kAllWell);
  keep_picture(p, "status_well");
  EXPECT_GT(pixels_like(p, kLayout.column, kGreen), 2000);
  EXPECT_EQ(pixels_like(p, kLayout.column, kAmber), 0);
  EXPECT_EQ(pixels_like(p, kLayout.column, kRed), 0);
  EXPECT_EQ(pixels_like(p, kLayout.view, kWhite), 0);
}

TEST(StatusPanel, TellsStaleAndLostApartByColour) {
  Status status = kAllWell;
  status.video = Freshness::stale;
  EXPECT_GT(pixels_like(drawn(status), kLayout.column, kAmber), 1000);
  status.video = Freshness::lost;
  EXPECT_GT(pixels_like(drawn(status), kLayout.column, kRed), 1000);
}

TEST(StatusPanel, TellsLiveAndStaleApartByWordAlone) {
  Status live = kAllWell, stale = kAllWell;
  stale.tracker = Freshness::stale;
  EXPECT_GT(difference(drawn(live), drawn(stale), kLayout.column), 500);
}

TEST(StatusPanel, SaysThatToolOrReferenceIsNotSeen) {
  Status status = kAllWell;
  status.tool_seen = false;
  const int one = pixels_like(drawn(status), kLayout.column, kAmber);
  EXPECT_GT(one, 5000);
  status.reference_seen = false;
  EXPECT_GT(pixels_like(drawn(status), kLayout.column, kAmber), one + 4000);
}

TEST(StatusPanel, BlanksTheInsetWithoutLiveVideo) {
  Status status = kAllWell;
  status.video = Freshness::lost;
  const Pixels p = drawn(status, InsetContent::blank);
  keep_picture(p, "status_no_video");
  const float r = kLayout.inset_radius_px;
  const HudBox middle{kLayout.inset_centre.x - 0.6F * r, kLayout.inset_centre.y - 0.6F * r, 1.2F * r,
                      1.2F * r};
  EXPECT_GT(pixels_like(p, middle, kRed), 500);
}

TEST(StatusPanel, FlashesForAnAcknowledgedCapture) {
  Status status = kAllWell;
  status.capture_acknowledged = true;
  const Pixels p = drawn(status);
  EXPECT_GT(pixels_like(p, {kLayout.view.x, 0, kLayout.view.width, 100}, kWhite), 5000);
}

TEST(StatusPanel, ShowsANoticeInTheColourOfItsLevelAndCutsALongOne) {
  Status status = kAllWell;
  status.notice.level = Notice::Level::alarm;
  status.notice.text.fill('M');
  const Pixels p = drawn(status);
  EXPECT_GT(pixels_like(p, {0, 600, kLayout.view.width, 150}, kRed), 5000);
  EXPECT_EQ(difference(drawn(kAllWell), p, kLayout.column), 0);
}

TEST(StatusPanel, WearsTheSimulatedMarkOnlyWhenSomethingIsSimulated) {
  Status status = kAllWell;
  EXPECT_GT(pixels_like(drawn(status), kLayout.bar, kAmber), 500);
  status.simulated = false;
  const Pixels real = drawn(status);
  EXPECT_EQ(pixels_like(real, kLayout.bar, kAmber), 0);
  EXPECT_GT(difference(real, drawn(kAllWell), kLayout.bar), 500);
}

TEST(StatusPanel, HasRoomForEveryWarningAtOnce) {
  Status status{.video = Freshness::stale,
                .degraded = true,
                .software_rendering = true,
                .capture_acknowledged = true,
                .captures = 12345,
                .late_frames = 99999,
                .budget_misses = 99999,
                .coverage = 1,
                .latency_ms = 999.9F};
  std::strcpy(status.notice.text.data(), "CAPTURE FAILED: the tool was not seen");
  status.notice.level = Notice::Level::warning;
  const Pixels p = drawn(status);
  keep_picture(p, "status_all_warnings");
  const HudBox seam{kLayout.column.x, kLayout.bar.y - 6, kLayout.column.width, 5};
  EXPECT_EQ(difference(p, drawn(kAllWell), seam), 0);
}

TEST(StatusPanel, NeverWritesOverTheMarkHoweverNarrowThePanelIs) {
  constexpr int kNarrow = 640, kLow = 480;
  Status late = kAllWell;
  late.simulated = true;
  const Pixels calm = drawn(late, InsetContent::picture, kNarrow, kLow);
  late.software_rendering = true;
  late.budget_misses = 306;
  late.missed_stage = "render + submit";
  const Pixels busy = drawn(late, InsetContent::picture, kNarrow, kLow);
  const HudBox bar = panel_layout(kNarrow, kLow).bar;
  EXPECT_EQ(difference(calm, busy, {0, bar.y, 340, bar.height}), 0) << "the mark ends at 330";
  EXPECT_GT(difference(calm, busy, {340, bar.y, 300, bar.height}), 300) << "what fits is said beside it";
}

}  // namespace
}  // namespace orcart
