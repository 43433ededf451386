// The lens in the shader against the lens on the CPU to hundredths of a pixel, and YUV against RGBA.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "render/atlas/painter.hpp"
#include "render/egl/context.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

constexpr double kPeriod_px = 8, kLevelsPerPixel = 63.75;

/// Up and down between 0 and 255 every 8 pixels: 64 levels a pixel.
double wave(double x_px) {
  return std::abs(x_px - kPeriod_px * std::round(x_px / kPeriod_px)) * kLevelsPerPixel;
}

/// Whether a bilinear look-up there stays on one straight piece of the wave.
bool on_straight_piece(double x_px) {
  const double to_turn = std::abs(std::remainder(x_px, kPeriod_px / 2));
  return to_turn > 1;
}

scenes::Rgba waves(const ScopeModel& scope) {
  scenes::Rgba picture{scope.width_px, scope.height_px, {}};
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x)
      picture.bytes.insert(picture.bytes.end(), {static_cast<std::uint8_t>(std::lround(wave(x))),
                                                 static_cast<std::uint8_t>(std::lround(wave(y))), 0, 255});
  return picture;
}

/// A plane before the scope, painted with one picture; a texel is a little finer than a pixel, so that none
/// are averaged.
struct PaintedPlane {
  GlContext context{std::move(*GlContext::create())};
  Surface surface = scenes::plane(20, 26, 10);
  AtlasLayout layout{std::move(*build_atlas(surface.mesh, {.texel_mm = 0.055}))};
  Painter painter;

  explicit PaintedPlane(const ScopeModel& scope)
      : painter(std::move(*Painter::create(surface, layout, scope, scenes::painted_by({})))) {}

  std::vector<std::uint8_t> paint(const ImageDescriptor& picture) {
    painter.clear();
    EXPECT_TRUE(painter.upload(picture));
    EXPECT_TRUE(painter.paint(scenes::whole(surface, {}), 1).painted);
    return painter.read_back().rgba;
  }
};

class ShaderLens : public ::testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(Models, ShaderLens,
                         ::testing::Values(LensModel::brown, LensModel::poly4, LensModel::fisheye));

TEST_P(ShaderLens, AgreesWithTheCpuToTwoHundredthsOfAPixel) {
  const ScopeModel scope = scenes::scope(GetParam());
  PaintedPlane plane(scope);
  auto picture = waves(scope);
  const auto rgba = plane.paint(picture.descriptor());
  double worst_px = 0;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < plane.layout.owners.size(); ++i) {
    if (plane.layout.inside[i] == 0 || rgba[4 * i + 3] != 255) continue;
    const auto pixel = project(scope.lens, scenes::point_of(plane.surface, plane.layout, i));
    ASSERT_TRUE(pixel.has_value());
    for (int axis = 0; axis < 2; ++axis) {
      if (!on_straight_piece((*pixel)[axis])) continue;
      const double levels = rgba[4 * i + static_cast<std::size_t>(axis)] - wave((*pixel)[axis]);
      worst_px = std::max(worst_px, std::abs(levels) / kLevelsPerPixel);
      ++looked_at;
    }
  }
  EXPECT_GT(looked_at, 10'000u);
  EXPECT_LT(worst_px, 0.02 + 1.0 / kLevelsPerPixel) << "a level is 0.016 px; half of one is lost twice";
  RecordProperty("worst_px", std::to_string(worst_px));
}

/// Luma and chroma that change from pixel to pixel, at a point of the picture.
std::array<double, 3> yuv_at(double x, double y) {
  return {60 + 0.2 * x + 0.1 * y, 100 + 0.08 * x, 160 - 0.1 * y};
}

/// BT.601, limited range.
std::array<double, 3> rgb_of(const std::array<double, 3>& yuv) {
  const double l = 255.0 / 219 * (yuv[0] - 16), b = yuv[1] - 128, r = yuv[2] - 128;
  return {l + 1.596027 * r, l - 0.391762 * b - 0.812968 * r, l + 2.017232 * b};
}

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::lround(value));
}

TEST(ShaderColours, OfNv12AndYuyvAreThoseOfTheSamePictureInRgb) {
  const ScopeModel scope = scenes::scope();
  PaintedPlane plane(scope);
  std::vector<std::uint8_t> yuyv, nv12;
  const int width = scope.width_px, height = scope.height_px;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      nv12.push_back(byte(yuv_at(x, y)[0]));
      yuyv.push_back(nv12.back());
      yuyv.push_back(byte(yuv_at(x - x % 2, y)[x % 2 == 0 ? 1 : 2]));  // chroma sited with the left pixel
    }
  }
  for (int y = 0; y < height; y += 2)
    for (int x = 0; x < width; x += 2)
      for (const std::size_t channel : {1u, 2u}) nv12.push_back(byte(yuv_at(x, y + 0.5)[channel]));

  const auto check = [&](std::vector<std::uint8_t>& bytes, PixelFormat format) {
    const auto rgba =
        plane.paint(packed_image(reinterpret_cast<std::byte*>(bytes.data()), format, width, height));
    double worst = 0;
    for (std::size_t i = 0; i < plane.layout.owners.size(); ++i) {
      if (plane.layout.inside[i] == 0 || rgba[4 * i + 3] != 255) continue;
      const auto pixel = project(scope.lens, scenes::point_of(plane.surface, plane.layout, i));
      const auto expected = rgb_of(yuv_at(pixel->x(), pixel->y()));
      for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(rgba[4 * i + c] - expected[c]));
    }
    EXPECT_LT(worst, 3) << "rounding of luma and chroma alone makes up to 2 levels";
  };
  check(yuyv, PixelFormat::yuyv);
  check(nv12, PixelFormat::nv12);
}

}  // namespace
}  // namespace orcart
