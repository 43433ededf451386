// Where the scope's strokes lie on the panel.
#include "render/views/scope_outline.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/support/offscreen.hpp"

namespace orcart {
namespace {

constexpr HudBox kView{0, 0, 1200, 800};
constexpr float kPxAMm = 4, kAround_px = 8;  // of strokes, and of the shaft's own width

/// Around the scope at M's origin, looked at along y from 300 mm: x to the right, z up, 4 px to the mm in the
/// scope's plane, the origin in the middle.
HudBox strokes_of(const ScopeOutline& outline) {
  testing::shared_context();
  auto canvas = HudCanvas::create({.width_px = 1200, .height_px = 800});
  EXPECT_TRUE(canvas) << canvas.error().message;
  const Eye eye{
      .position_mm = {0, -300, 0}, .up = {0, 0, 1}, .field_of_view_rad = 2 * std::atan(100.0 / 300)};
  draw_scope(*canvas, kView, eye, outline);
  return canvas->bounds();
}

TEST(ScopeOutline, AStraightShaftLiesBehindTheView) {
  const HudBox strokes = strokes_of({.cone_half_angle_rad = 0.6});
  EXPECT_NEAR(strokes.y + strokes.height, 400 + 70 * kPxAMm, kAround_px);
  EXPECT_NEAR(strokes.x, 600 - std::tan(0.6F) * 9 * kPxAMm, kAround_px) << "the cone's rim";
}

TEST(ScopeOutline, AnAngledScopesShaftLiesWhereItIs) {
  const double angle = 30 * M_PI / 180;
  const HudBox strokes =
      strokes_of({.shaft = Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)), .cone_half_angle_rad = 0.6});
  EXPECT_NEAR(strokes.x, 600 - 70 * std::sin(angle) * kPxAMm, kAround_px);
  EXPECT_NEAR(strokes.y + strokes.height, 400 + 70 * std::cos(angle) * kPxAMm, kAround_px);
}

TEST(ScopeOutline, AShaftThatIsNotKnownIsNotDrawn) {
  const HudBox strokes = strokes_of({.shaft = std::nullopt, .cone_half_angle_rad = 0.6});
  EXPECT_LT(strokes.y + strokes.height, 420);
}

}  // namespace
}  // namespace orcart
