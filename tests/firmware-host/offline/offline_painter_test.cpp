// The cart's own mapper and painter, driven view by view: what is where after painting, and what is refused.
#include "firmware-host/offline/offline_painter.hpp"

#include <gtest/gtest.h>

#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

constexpr std::array<std::uint8_t, 3> kRed = {220, 30, 20}, kBlue = {20, 40, 210};

Result<OfflinePainter> painter_on(const Surface& surface, OfflinePaintOptions options = {.texel_mm = 0.4}) {
  return OfflinePainter::create(surface, scenes::scope(), options);
}

scenes::Rgba picture_in(const std::array<std::uint8_t, 3>& colour) {
  return scenes::flat(scenes::scope(), colour[0], colour[1], colour[2]);
}

/// Calls visit(point in M, texel's RGBA) for every texel with paint; their count.
template <class Visit>
std::size_t for_each_painted(const Surface& surface, OfflinePainter& painter, Visit visit) {
  const AtlasLayout& layout = painter.layout();
  const AtlasPicture picture = painter.painter().read_back();
  std::size_t painted = 0;
  for (std::size_t i = 0; i < layout.inside.size(); ++i) {
    if (layout.inside[i] == 0 || picture.rgba[4 * i + 3] == 0) continue;
    ++painted;
    visit(scenes::point_of(surface, layout, i), &picture.rgba[4 * i]);
  }
  return painted;
}

TEST(OfflinePainter, PaintsWhatTheLensSees) {
  const Surface plane = scenes::plane(20, 20, 10);
  const ScopeModel scope = scenes::scope();
  auto painter = painter_on(plane, {.texel_mm = 0.055});  // finer than a pixel
  ASSERT_TRUE(painter) << painter.error().message;
  auto ramp = scenes::ramp(scope);
  const auto painted = painter->paint(ramp.descriptor(), {});
  ASSERT_TRUE(painted) << painted.error().message;
  EXPECT_EQ(painted->triangles, plane.mesh.triangles.size());
  double worst_px = 0;
  const std::size_t texels =
      for_each_painted(plane, *painter, [&](const Eigen::Vector3d& p, const auto* rgba) {
        const auto pixel = project(scope.lens, p);
        ASSERT_TRUE(pixel);
        worst_px = std::max({worst_px, std::abs(pixel->x() - rgba[0] * (639.0 / 255)),
                             std::abs(pixel->y() - rgba[1] * (479.0 / 255))});
      });
  EXPECT_GT(texels, 2000U);
  EXPECT_LT(worst_px, 2.6);  // a step of the ramp is 2.5 px
}

TEST(OfflinePainter, TheNewestViewWins) {
  const Surface plane = scenes::plane(20, 8, 4);
  auto painter = painter_on(plane);
  ASSERT_TRUE(painter) << painter.error().message;
  auto red = picture_in(kRed), blue = picture_in(kBlue);
  ASSERT_TRUE(painter->paint(red.descriptor(), {}));
  ASSERT_TRUE(painter->paint(blue.descriptor(), {}));
  EXPECT_GT(for_each_painted(plane, *painter,
                             [](const Eigen::Vector3d&, const auto* rgba) { EXPECT_NEAR(rgba[2], 210, 3); }),
            300U);
}

TEST(OfflinePainter, GoesThroughAllPartsOfALargeView) {
  const Surface plane = scenes::plane(20, 20, 120);  // 14,641 vertices: more than the rays of one part
  auto painter = painter_on(plane);
  ASSERT_TRUE(painter) << painter.error().message;
  auto red = picture_in(kRed);
  const auto painted = painter->paint(red.descriptor(), {});
  ASSERT_TRUE(painted) << painted.error().message;
  EXPECT_EQ(painted->triangles, 28'800U);
  EXPECT_NEAR(painter->painter().coverage(), 1, 0.02);
}

TEST(OfflinePainter, PaintsNothingThatIsHiddenOrFacesAway) {
  Surface surface = scenes::plane(20, 20, 10);
  scenes::append(surface, scenes::plane(30, 20, 10));
  auto painter = painter_on(surface);
  ASSERT_TRUE(painter) << painter.error().message;
  auto red = picture_in(kRed);
  ASSERT_TRUE(painter->paint(red.descriptor(), {}));
  for_each_painted(surface, *painter,
                   [](const Eigen::Vector3d& p, const auto*) { EXPECT_NEAR(p.z(), 20, 1e-3); });

  auto inside = painter_on(surface, {.seen_from = SeenFrom::inside, .texel_mm = 0.4});
  ASSERT_TRUE(inside) << inside.error().message;
  EXPECT_EQ(inside->paint(red.descriptor(), {})->triangles, 0U);
  EXPECT_EQ(for_each_painted(surface, *inside, [](const Eigen::Vector3d&, const auto*) {}), 0U);
}

TEST(OfflinePainter, RefusesAPictureOfAnotherSize) {
  auto painter = painter_on(scenes::plane(20, 8, 4));
  ASSERT_TRUE(painter) << painter.error().message;
  scenes::Rgba small{320, 240, std::vector<std::uint8_t>(std::size_t{320} * 240 * 4)};
  const auto painted = painter->paint(small.descriptor(), {});
  ASSERT_FALSE(painted);
  EXPECT_NE(painted.error().message.find("320x240 pixels, the scope's calibration is for 640x480"),
            std::string::npos);
}

TEST(OfflinePainter, PaperModePaintsAndRefusesAViewWithoutItsCentre) {
  const Surface plane = scenes::plane(20, 20, 10);
  auto painter = painter_on(plane, {.mode = TextureMode::paper, .texel_mm = 0.4});
  ASSERT_TRUE(painter) << painter.error().message;
  auto red = picture_in(kRed);
  ASSERT_TRUE(painter->paint(red.descriptor(), {}));
  EXPECT_GT(for_each_painted(plane, *painter, [](const Eigen::Vector3d&, const auto*) {}), 2000U);
  const Pose<M, C> beside{.translation_mm = {14, 0, 0}};
  const auto missed = painter->paint(red.descriptor(), beside);
  ASSERT_FALSE(missed);
  EXPECT_NE(missed.error().message.find("central ray misses"), std::string::npos);
}

}  // namespace
}  // namespace orcart
