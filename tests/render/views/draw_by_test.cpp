// The driver and the processor's vector units draw the same picture of the same paint.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "render/views/screen.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

using testing::Pixels;

constexpr int kWidth = 733, kHeight = 500;  // the view's rows are no whole number of vectors

/// A screen of each kind before one painter, whose atlas is in textures and in memory.
class BothScreens {
 public:
  explicit BothScreens(ScreenSettings settings = {}, PixelFormat format = PixelFormat::rgba8888)
      : settings_(settings), format_(format) {
    testing::shared_context();
    scenes::append(surface_, scenes::sphere({6, 3, 20}, 5, 12));
    settings_.width_px = kWidth;
    settings_.height_px = kHeight;
    layout_ = std::move(*build_atlas(surface_.mesh, {.texel_mm = 0.3}));
    painter_ = std::make_unique<Painter>(std::move(*Painter::create(
        surface_, layout_, scope_, {.seen_from = settings_.seen_from, .paint_by = PaintBy::processor})));
    for (const PaintBy by : {PaintBy::gpu, PaintBy::processor}) {
      settings_.draw_by = by;
      screens_.push_back(std::move(*Screen::create(surface_, layout_, scope_, settings_)));
    }
    state.eye = eye_on(surface_.mesh, {0.3, 0.2, -1}, {0, -1, 0});
    state.status.video = state.status.tracker = Freshness::live;
  }

  void paint(std::uint32_t unit) {
    std::vector<std::byte> bytes(packed_bytes(format_, scope_.width_px, scope_.height_px));
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::byte>(std::lround(128 + 80 * std::sin(static_cast<double>(i % 640) / 50) +
                                                    30 * std::sin(static_cast<double>(i) / 64'000)));
    ASSERT_TRUE(painter_->upload(packed_image(bytes.data(), format_, scope_.width_px, scope_.height_px)));
    Pose<M, C> X_MC;
    X_MC.translation_mm = {3.0 * unit - 5, 1, settings_.seen_from == SeenFrom::inside ? 28.0 : 0.0};
    ASSERT_TRUE(painter_->paint(scenes::whole(surface_, X_MC), unit).painted);
    ASSERT_GT(painter_->coverage(), 0.03);
    state.X_MC = X_MC;
    ++state.paint_version;
  }

  Pixels draw(std::size_t screen) {
    Pixels pixels{kWidth, kHeight,
                  std::vector<std::uint8_t>(packed_bytes(PixelFormat::rgba8888, kWidth, kHeight))};
    EXPECT_TRUE(screens_[screen].draw(state, *painter_,
                                      packed_image(reinterpret_cast<std::byte*>(pixels.rgba.data()),
                                                   PixelFormat::rgba8888, kWidth, kHeight)));
    return pixels;
  }

  /// But for pixels on the border of two triangles, of surface and ground, or of two texels' records.
  void expect_alike(const std::string& name, double most_share = 0.002) {
    const Pixels a = draw(0), b = draw(1);
    testing::keep_picture(a, "draw_by_gpu_" + name);
    testing::keep_picture(b, "draw_by_processor_" + name);
    std::size_t other = 0, of_surface = 0;
    const std::array<int, 4> ground = a.at(1, 1);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::array<int, 4> p = a.at(x, y), q = b.at(x, y);
        of_surface += p != ground ? 1U : 0U;
        int apart = 0;
        for (std::size_t c = 0; c < 3; ++c) apart = std::max(apart, std::abs(p[c] - q[c]));
        other += apart > 4 ? 1U : 0U;
      }
    EXPECT_GT(of_surface, 50'000U) << name;
    EXPECT_LT(static_cast<double>(other), most_share * kWidth * kHeight) << name;
  }

  Painter& painter() { return *painter_; }
  ScreenState state;

 private:
  Surface surface_ = scenes::sphere({0, 0, 38}, 22, 40);
  AtlasLayout layout_;
  ScopeModel scope_ = scenes::scope();
  ScreenSettings settings_;
  PixelFormat format_;
  std::unique_ptr<Painter> painter_;
  std::vector<Screen> screens_;
};

TEST(DrawBy, DriverAndProcessorDrawTheSame) {
  BothScreens both;
  both.expect_alike("bare");
  both.paint(1);
  both.expect_alike("painted");
  both.paint(2);
  both.expect_alike("painted_on");
  both.state.eye = stereo_eyes(both.state.eye, 0.2).left;
  both.expect_alike("left_eye");
}

TEST(DrawBy, ACavityIsTheSame) {
  BothScreens both({.seen_from = SeenFrom::inside});
  both.paint(1);
  both.expect_alike("cavity");
}

TEST(DrawBy, WhatReachesBehindTheEyeIsTheSame) {
  for (const SeenFrom seen_from : {SeenFrom::outside, SeenFrom::inside}) {
    BothScreens both({.seen_from = seen_from});
    both.paint(1);
    both.state.eye = {
        .position_mm = {0, 0, 17}, .target_mm = {1, 0, 60}, .up = {0, -1, 0}, .field_of_view_rad = 1.6};
    both.expect_alike(seen_from == SeenFrom::inside ? "within_cavity" : "within");
  }
}

TEST(DrawBy, EveryColourIsTheSame) {
  for (const ColourBy by : {ColourBy::capture, ColourBy::angle, ColourBy::resolution, ColourBy::error}) {
    BothScreens both({.colour_by = by});
    both.painter().set_view_error({.position_mm = 0.4F, .angle_rad = 0.01F});
    both.paint(1);
    both.paint(2);
    both.expect_alike("colour_" + std::to_string(static_cast<int>(by)), 0.01);
  }
}

TEST(DrawBy, ACoarserViewIsTheSameUntilItIsFine) {
  BothScreens both({.most_triangles = 2'000});
  both.paint(1);
  for (int i = 0; i < 6; ++i) both.expect_alike("coarse_" + std::to_string(i));
}

TEST(DrawBy, AfterUndoRedoAndClearingItIsTheSame) {
  BothScreens both;
  both.paint(1);
  both.paint(2);
  const auto each = [&](const char* name, auto act) {
    act(both.painter());
    ++both.state.paint_version;
    both.expect_alike(name);
  };
  each("undone", [](Painter& painter) { EXPECT_TRUE(painter.undo()); });
  each("redone", [](Painter& painter) { EXPECT_TRUE(painter.redo()); });
  each("cleared", [](Painter& painter) { painter.clear(); });
}

TEST(DrawBy, EveryFormatOfTheLivePictureIsTheSame) {
  for (const PixelFormat format :
       {PixelFormat::nv12, PixelFormat::yuyv, PixelFormat::uyvy, PixelFormat::gray8}) {
    BothScreens both({}, format);
    both.paint(1);
    both.expect_alike("format_" + std::to_string(static_cast<std::uint32_t>(format)));
  }
}

/// What this processor has and less: carts have other ones.
TEST(DrawBy, EveryWidthOfVectorsIsTheSame) {
  int tried = 0;
  for (const std::int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4, HWY_SSSE3, HWY_NEON, HWY_SCALAR}) {
    hwy::SetSupportedTargetsForTest(0);
    if ((hwy::SupportedTargets() & target) == 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    BothScreens both({.seen_from = SeenFrom::inside});
    both.paint(1);
    both.expect_alike("width_" + std::to_string(tried++));
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GT(tried, 0);
}

TEST(DrawBy, TheProcessorRefusesWhatItHasNotPainted) {
  testing::shared_context();
  const Surface wall = scenes::plane(20, 60, 8);
  const AtlasLayout layout = *build_atlas(wall.mesh, {.texel_mm = 0.5});
  const Painter by_gpu = std::move(*Painter::create(wall, layout, scenes::scope(), {}));
  Screen screen =
      std::move(*Screen::create(wall, layout, scenes::scope(),
                                {.width_px = kWidth, .height_px = kHeight, .draw_by = PaintBy::processor}));
  std::vector<std::byte> bytes(packed_bytes(PixelFormat::rgba8888, kWidth, kHeight));
  EXPECT_FALSE(screen.draw({}, by_gpu, packed_image(bytes.data(), PixelFormat::rgba8888, kWidth, kHeight)));
}

}  // namespace
}  // namespace orcart
