// The panel's picture, pixel by pixel where it matters.
#include "render/views/screen.hpp"

#include <gtest/gtest.h>

#include "render/hud/status_panel.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

using testing::Pixels;

constexpr int kWidth = 960, kHeight = 600;

class ScreenTest : public ::testing::Test {
 protected:
  void use(Surface surface, SeenFrom seen_from = SeenFrom::outside) {
    testing::shared_context();
    surface_ = std::move(surface);
    layout_ = std::move(*build_atlas(surface_.mesh, {.texel_mm = 0.3}));
    painter_ = std::make_unique<Painter>(
        std::move(*Painter::create(surface_, layout_, scope_, scenes::painted_by({.seen_from = seen_from}))));
    settings_.seen_from = seen_from;
    screen_ = std::make_unique<Screen>(make_screen());
    state_.eye = eye_on(surface_.mesh, {0, 0, -1}, {0, -1, 0});
    state_.status.video = state_.status.tracker = Freshness::live;
    state_.status.tool_seen = state_.status.reference_seen = true;
  }

  Screen make_screen() {
    auto screen = Screen::create(surface_, layout_, scope_, settings_);
    EXPECT_TRUE(screen.has_value()) << screen.error().message;
    return std::move(*screen);
  }

  Pixels drawn_by(Screen& screen, PixelFormat format = PixelFormat::rgba8888) {
    Pixels pixels{kWidth, kHeight, std::vector<std::uint8_t>(packed_bytes(format, kWidth, kHeight))};
    EXPECT_TRUE(
        screen.draw(state_, *painter_,
                    packed_image(reinterpret_cast<std::byte*>(pixels.rgba.data()), format, kWidth, kHeight)));
    return pixels;
  }
  Pixels drawn() { return drawn_by(*screen_); }

  void paint(std::uint8_t r, std::uint8_t g, std::uint8_t b, const Pose<M, C>& X_MC, std::uint32_t unit) {
    auto picture = scenes::flat(scope_, r, g, b);
    painter_->upload(picture.descriptor());
    painter_->paint(scenes::whole(surface_, X_MC), unit);
    ++state_.paint_version;
  }

  std::array<int, 4> view_centre(const Pixels& pixels) const {
    const HudBox& view = layout_of_panel_.view;
    return pixels.at(static_cast<int>(view.x + view.width / 2), static_cast<int>(view.y + view.height / 2));
  }

  ScopeModel scope_ = scenes::scope();
  ScreenSettings settings_{.width_px = kWidth, .height_px = kHeight, .draw_by = scenes::kPaintBy};
  PanelLayout layout_of_panel_ = panel_layout(kWidth, kHeight);
  Surface surface_;
  AtlasLayout layout_;
  std::unique_ptr<Painter> painter_;
  std::unique_ptr<Screen> screen_;
  ScreenState state_;
};

/// A scope before a plane at z = 20, moved sideways.
Pose<M, C> beside(double x_mm, double y_mm) {
  Pose<M, C> X_MC;
  X_MC.translation_mm = {x_mm, y_mm, 0};
  return X_MC;
}

TEST_F(ScreenTest, DrawsTheSameBytesWhileNothingChanges) {
  use(scenes::plane(20, 60, 8));
  paint(200, 30, 30, {}, 1);
  EXPECT_EQ(drawn().rgba, drawn().rgba);
}

TEST_F(ScreenTest, ShowsPaintInTheMiddleOfTheView) {
  use(scenes::plane(20, 60, 8));
  const auto bare = view_centre(drawn());
  EXPECT_NEAR(bare[0], bare[2], 60) << "unpainted tissue is a quiet grey";
  EXPECT_GT(bare[0], 60);
  paint(250, 20, 20, {}, 1);
  const auto painted = view_centre(drawn());
  EXPECT_GT(painted[0], 200);
  EXPECT_LT(painted[1], 40);
}

TEST_F(ScreenTest, RedrawsPartsExactlyAsAWholeRedrawWould) {
  use(scenes::sphere({0, 0, 40}, 22, 30));
  (void)drawn();
  for (std::uint32_t unit = 1; unit <= 5; ++unit) {
    paint(static_cast<std::uint8_t>(40 * unit), 90, 200, beside(6.0 * unit - 18, 5 - 2.0 * unit), unit);
    const Pixels part = drawn();
    Screen fresh = make_screen();
    ASSERT_EQ(part.rgba, drawn_by(fresh).rgba) << "after unit " << unit;
  }
  painter_->undo();
  ++state_.paint_version;
  const Pixels part = drawn();
  Screen fresh = make_screen();
  EXPECT_EQ(part.rgba, drawn_by(fresh).rgba) << "after undo";
}

TEST_F(ScreenTest, RestoresWhatOutlineAndWordsCoveredAndNothingElse) {
  use(scenes::sphere({0, 0, 40}, 22, 30));
  paint(250, 90, 20, {}, 1);
  const auto expect_as_drawn_anew = [&](const char* when) {
    const Pixels part = drawn();
    Screen fresh = make_screen();
    EXPECT_EQ(part.rgba, drawn_by(fresh).rgba) << when;
  };
  expect_as_drawn_anew("first");
  for (int i = 0; i < 6; ++i) {
    state_.X_MC = beside(9.0 * i - 22, 6.0 * i - 15);  // from rim to rim, over the column's edge too
    state_.status.captures = static_cast<std::uint32_t>(i / 2);
    state_.status.capture_acknowledged = i % 3 == 1;
    expect_as_drawn_anew("the scope moves");
  }
  state_.show_live = false;
  expect_as_drawn_anew("no live picture");
  state_.X_MC.reset();
  expect_as_drawn_anew("no scope");
  state_.show_live = true;
  paint(20, 90, 220, beside(4, 4), 2);
  expect_as_drawn_anew("painted on");
}

TEST_F(ScreenTest, CatchesUpAfterMorePicturesThanAreRemembered) {
  use(scenes::plane(20, 60, 8));
  (void)drawn();
  for (std::uint32_t unit = 1; unit <= 40; ++unit)
    paint(static_cast<std::uint8_t>(6 * unit), 90, 200, beside(unit - 20.0, 0), unit);
  const Pixels part = drawn();
  Screen fresh = make_screen();
  EXPECT_EQ(part.rgba, drawn_by(fresh).rgba);
}

TEST_F(ScreenTest, LooksThroughTheNearWallOfACavity) {
  use(scenes::sphere({0, 0, 0}, 20, 30), SeenFrom::inside);
  paint(250, 20, 20, {}, 1);  // from the middle, the far wall
  const Pixels p = drawn();
  keep_picture(p, "screen_cavity");
  EXPECT_GT(view_centre(p)[0], 180);
  EXPECT_LT(view_centre(p)[1], 60);
}

TEST_F(ScreenTest, ShowsTheLivePictureInItsInsetAndBlanksIt) {
  use(scenes::plane(20, 60, 8));
  auto picture = scenes::flat(scope_, 20, 220, 40);
  painter_->upload(picture.descriptor());
  const int x = static_cast<int>(layout_of_panel_.inset_centre.x);
  const int y = static_cast<int>(layout_of_panel_.inset_centre.y - layout_of_panel_.inset_radius_px / 2);
  EXPECT_NEAR(drawn().at(x, y)[1], 220, 2);
  state_.show_live = false;
  EXPECT_LT(drawn().at(x, y)[1], 40);
}

TEST_F(ScreenTest, TheInsetIsBlackBesideThePicture) {
  scope_.mask = {.cx_px = 319.5, .cy_px = 239.5, .radius_px = 400, .soft_edge_px = 6};  // to the corners
  use(scenes::plane(20, 60, 8));
  auto picture = scenes::flat(scope_, 20, 220, 40);
  painter_->upload(picture.descriptor());
  const int x = static_cast<int>(layout_of_panel_.inset_centre.x);
  const auto green = [&](double up) {
    const double y = layout_of_panel_.inset_centre.y - up * layout_of_panel_.inset_radius_px;
    return drawn().at(x, static_cast<int>(y))[1];
  };
  EXPECT_NEAR(green(0.55), 220, 2);
  EXPECT_LT(green(0.65), 10) << "400 * 0.65 px up is above the first row";
}

TEST_F(ScreenTest, OutlinesTheScopeOnlyWhereItIsKnown) {
  use(scenes::plane(20, 60, 8));
  const Pixels without = drawn();
  state_.X_MC = beside(0, 0);
  const Pixels with = drawn();
  EXPECT_NE(without.rgba, with.rgba);
  state_.scope_predicted = true;
  EXPECT_NE(drawn().rgba, with.rgba) << "a predicted pose looks different";
  state_.X_MC.reset();
  EXPECT_EQ(drawn().rgba, without.rgba);
}

TEST_F(ScreenTest, WritesThePanelsOrderOfBytesAndRows) {
  use(scenes::plane(20, 60, 8));
  paint(250, 20, 20, {}, 1);
  const Pixels rgba = drawn(), bgrx = drawn_by(*screen_, PixelFormat::xrgb8888);
  for (std::size_t i = 0; i < rgba.rgba.size(); i += 4) {
    ASSERT_EQ(rgba.rgba[i], bgrx.rgba[i + 2]);
    ASSERT_EQ(rgba.rgba[i + 2], bgrx.rgba[i]);
  }
  int amber = 0;
  for (int y = kHeight - 36; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2; ++x) amber += rgba.at(x, y)[0] > 200 && rgba.at(x, y)[2] < 100;
  EXPECT_GT(amber, 200) << "SIMULATED stands in the last rows";
}

TEST_F(ScreenTest, RespectsTheStrideOfThePanelsBuffer) {
  use(scenes::plane(20, 60, 8));
  const Pixels tight = drawn();
  constexpr std::size_t kStride = 4 * kWidth + 256;
  std::vector<std::uint8_t> wide(kStride * kHeight, 77);
  ImageDescriptor target =
      packed_image(reinterpret_cast<std::byte*>(wide.data()), PixelFormat::rgba8888, kWidth, kHeight);
  target.planes[0].stride_bytes = kStride;
  ASSERT_TRUE(screen_->draw(state_, *painter_, target));
  for (std::size_t y = 0; y < kHeight; ++y) {
    ASSERT_TRUE(std::equal(wide.begin() + static_cast<std::ptrdiff_t>(y * kStride),
                           wide.begin() + static_cast<std::ptrdiff_t>(y * kStride + 4 * kWidth),
                           tight.rgba.begin() + static_cast<std::ptrdiff_t>(y * 4 * kWidth)));
    ASSERT_EQ(wide[y * kStride + 4 * kWidth + 5], 77) << "beyond the row's end nothing is written";
  }
}

TEST_F(ScreenTest, RefusesABufferItCannotWrite) {
  use(scenes::plane(20, 60, 8));
  std::vector<std::byte> bytes(packed_bytes(PixelFormat::rgba8888, kWidth, kHeight));
  EXPECT_FALSE(screen_->draw(state_, *painter_,
                             packed_image(bytes.data(), PixelFormat::rgba8888, kWidth, kHeight - 1)));
  EXPECT_FALSE(
      screen_->draw(state_, *painter_, packed_image(bytes.data(), PixelFormat::nv12, kWidth, kHeight)));
  EXPECT_FALSE(
      screen_->draw(state_, *painter_, packed_image(nullptr, PixelFormat::rgba8888, kWidth, kHeight)));
}

TEST_F(ScreenTest, MakesAFigureOfTheSurfaceAlone) {
  use(scenes::sphere({0, 0, 40}, 22, 30));
  paint(250, 20, 20, {}, 1);
  const auto figure = picture_of_surface(surface_, layout_, *painter_, state_.eye,
                                         {.width_px = 300, .height_px = 200, .draw_by = scenes::kPaintBy});
  ASSERT_TRUE(figure.has_value()) << figure.error().message;
  const Pixels p{figure->width_texels, figure->height_texels, figure->rgba};
  keep_picture(p, "figure");
  EXPECT_GT(p.at(150, 100)[0], 200);
  EXPECT_EQ(p.at(150, 100)[3], 255);
  EXPECT_EQ(p.at(2, 2), p.at(297, 197)) << "nothing but ground in the corners";
}

}  // namespace
}  // namespace orcart
