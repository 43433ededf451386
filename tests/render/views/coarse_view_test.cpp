// A surface of too many triangles: coarser while the eye moves, the same bytes as drawn at once when it
// stands still.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/views/screen.hpp"
#include "render/views/view_mesh.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

using testing::Pixels;

constexpr int kWidth = 800, kHeight = 500;

TEST(CoarserMesh, StaysBelowItsLimitAndWithinItsCharts) {
  const Surface sphere = scenes::sphere({0, 0, 0}, 20, 60);
  const AtlasLayout layout = *build_atlas(sphere.mesh, {.texel_mm = 0.4});
  const ViewMesh fine = view_mesh(sphere.mesh, layout);
  EXPECT_EQ(fine.indices.size(), 3 * sphere.mesh.triangles.size());
  for (const std::size_t most : {6'000U, 1'500U, 300U}) {
    const ViewMesh coarse = coarser(fine, most);
    EXPECT_LE(coarse.indices.size() / 3, most);
    EXPECT_GT(coarse.indices.size() / 3, most / 3);
    for (std::size_t i = 0; i < coarse.vertices.size(); ++i) {
      const ViewVertex& vertex = coarse.vertices[i];
      const ChartRect& rect = layout.charts[coarse.charts[i]];
      EXPECT_GE(vertex.texel[0], rect.x);
      EXPECT_LE(vertex.texel[0], rect.x + rect.width);
      const double radius = std::hypot(vertex.position[0], vertex.position[1], vertex.position[2]);
      EXPECT_NEAR(radius, 20, 3);
    }
  }
}

TEST(CoarserMesh, IsTheFineOneWhereThatIsSmallEnough) {
  const Surface sphere = scenes::sphere({0, 0, 0}, 20, 10);
  const ViewMesh fine = view_mesh(sphere.mesh, *build_atlas(sphere.mesh, {.texel_mm = 0.4}));
  EXPECT_EQ(coarser(fine, 10'000).indices, fine.indices);
}

class CoarseView : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::shared_context();
    surface_ = scenes::sphere({0, 0, 35}, 15, 40);
    layout_ = *build_atlas(surface_.mesh, {.texel_mm = 0.3});
    painter_ = std::make_unique<Painter>(
        std::move(*Painter::create(surface_, layout_, scope_, scenes::painted_by({}))));
    auto ramp = scenes::ramp(scope_);
    painter_->upload(ramp.descriptor());
    painter_->paint(scenes::whole(surface_, {}), 1);
    state_.eye = eye_on(surface_.mesh, {0.3, 0.1, -1}, {0, -1, 0});
  }
  Screen screen(std::size_t most_triangles, SeenFrom seen_from = SeenFrom::outside) const {
    return std::move(*Screen::create(surface_, layout_, scope_,
                                     {.width_px = kWidth,
                                      .height_px = kHeight,
                                      .seen_from = seen_from,
                                      .most_triangles = most_triangles,
                                      .draw_by = scenes::kPaintBy}));
  }
  Pixels drawn(Screen& screen) {
    Pixels pixels{kWidth, kHeight,
                  std::vector<std::uint8_t>(packed_bytes(PixelFormat::rgba8888, kWidth, kHeight))};
    EXPECT_TRUE(screen.draw(state_, *painter_,
                            packed_image(reinterpret_cast<std::byte*>(pixels.rgba.data()),
                                         PixelFormat::rgba8888, kWidth, kHeight)));
    return pixels;
  }

  ScopeModel scope_ = scenes::scope();
  Surface surface_;
  AtlasLayout layout_;
  std::unique_ptr<Painter> painter_;
  ScreenState state_{.show_live = false};
};

double mean_difference(const Pixels& a, const Pixels& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int(a.rgba[i]) - int(b.rgba[i]));
  return sum / static_cast<double>(a.rgba.size());
}

TEST_F(CoarseView, BecomesTheFineOneWhileTheEyeStandsStill) {
  Screen at_once = screen(1'000'000), in_parts = screen(1'000);  // 6,240 triangles
  const Pixels fine = drawn(at_once);
  const Pixels first = drawn(in_parts);
  EXPECT_NE(first.rgba, fine.rgba);
  EXPECT_LT(mean_difference(first, fine), 4) << "coarse, and yet the same painting";
  testing::keep_picture(first, "coarse_first");
  testing::keep_picture(fine, "coarse_fine");
  Pixels last = first;
  for (int i = 0; i < 7; ++i) last = drawn(in_parts);
  EXPECT_EQ(last.rgba, fine.rgba);
}

TEST_F(CoarseView, ShowsPaintThatComesWhileItBecomesFine) {
  Screen at_once = screen(1'000'000), in_parts = screen(1'000);
  (void)drawn(in_parts);
  (void)drawn(in_parts);
  auto blue = scenes::flat(scope_, 0, 0, 220);
  painter_->upload(blue.descriptor());
  painter_->paint(scenes::whole(surface_, {}), 2);
  ++state_.paint_version;
  Pixels last = drawn(in_parts);
  for (int i = 0; i < 7; ++i) last = drawn(in_parts);
  EXPECT_EQ(last.rgba, drawn(at_once).rgba);
}

}  // namespace
}  // namespace orcart
