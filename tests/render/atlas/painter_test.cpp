// The painter against the lens on the CPU: where pictures land, what hides, what is taken back.
#include "render/atlas/painter.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "render/egl/context.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

class PainterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto context = GlContext::create();
    ASSERT_TRUE(context.has_value()) << context.error().message;
    context_ = std::make_unique<GlContext>(std::move(*context));
  }

  void use(Surface surface, const ScopeModel& scope, double texel_mm = 0.2,
           SeenFrom seen_from = SeenFrom::outside) {
    surface_ = std::move(surface);
    layout_ = *build_atlas(surface_.mesh, {.texel_mm = texel_mm});
    auto painter = Painter::create(surface_, layout_, scope, scenes::painted_by({.seen_from = seen_from}));
    ASSERT_TRUE(painter.has_value()) << painter.error().message;
    painter_ = std::make_unique<Painter>(std::move(*painter));
  }

  /// Texels that carry full paint, with the point they stand for.
  template <class Visit>
  std::size_t for_each_painted(Visit visit) {
    const AtlasPicture picture = painter_->read_back();
    std::size_t count = 0;
    for (std::size_t i = 0; i < layout_.owners.size(); ++i) {
      if (layout_.inside[i] == 0 || picture.rgba[4 * i + 3] != 255) continue;
      visit(scenes::point_of(surface_, layout_, i), picture.rgba.data() + 4 * i);
      ++count;
    }
    return count;
  }

  std::unique_ptr<GlContext> context_;
  Surface surface_;
  AtlasLayout layout_;
  std::unique_ptr<Painter> painter_;
};

class PainterLens : public PainterTest, public ::testing::WithParamInterface<LensModel> {};

TEST_P(PainterLens, PutsEveryPixelWhereTheLensSaysItComesFrom) {
  const ScopeModel scope = scenes::scope(GetParam());
  ASSERT_NO_FATAL_FAILURE(use(scenes::plane(20, 26, 10), scope, 0.055));  // a texel is finer than a pixel
  auto ramp = scenes::ramp(scope);
  ASSERT_TRUE(painter_->upload(ramp.descriptor()));
  ASSERT_TRUE(painter_->paint(scenes::whole(surface_, {}), 1).painted);
  double worst_px = 0;
  const std::size_t painted = for_each_painted([&](const Eigen::Vector3d& p, const std::uint8_t* rgba) {
    const auto pixel = project(scope.lens, p);
    ASSERT_TRUE(pixel.has_value());
    worst_px = std::max(worst_px, std::abs(rgba[0] * 639.0 / 255 - pixel->x()));
    worst_px = std::max(worst_px, std::abs(rgba[1] * 479.0 / 255 - pixel->y()));
  });
  EXPECT_GT(painted, 10'000u);
  EXPECT_LT(worst_px, 2.6) << "a level of the ramp is 2.5 px wide";
}
INSTANTIATE_TEST_SUITE_P(Models, PainterLens,
                         ::testing::Values(LensModel::brown, LensModel::poly4, LensModel::fisheye));

TEST_F(PainterTest, LeavesWhatTheCircleHasBesideThePictureUnpainted) {
  ScopeModel scope = scenes::scope();
  scope.mask = {.cx_px = 319.5, .cy_px = 239.5, .radius_px = 400, .soft_edge_px = 6};  // to the corners
  scope.cone_half_angle_rad = 1;
  ASSERT_NO_FATAL_FAILURE(use(scenes::plane(20, 80, 20), scope));
  auto picture = scenes::flat(scope, 200, 10, 10);
  painter_->upload(picture.descriptor());
  painter_->paint(scenes::whole(surface_, {}), 1);
  const AtlasRecords records = painter_->read_records();
  std::size_t painted = 0, beside = 0;
  for (std::size_t i = 0; i < layout_.owners.size(); ++i) {
    if (layout_.inside[i] == 0 || records.texels[i].capture == 0) continue;
    ++painted;
    const auto pixel = project(scope.lens, scenes::point_of(surface_, layout_, i));
    beside += !pixel || std::abs(pixel->x() - 319.5) > 320.1 || std::abs(pixel->y() - 239.5) > 240.1;
  }
  EXPECT_GT(painted, 20'000u);
  EXPECT_EQ(beside, 0u);
}

TEST_F(PainterTest, LeavesWhatIsHiddenBehindANearerPlateUnpainted) {
  const ScopeModel scope = scenes::scope();
  Surface surface = scenes::plane(30, 40, 12);
  scenes::append(surface, scenes::plane(15, 6, 3));
  ASSERT_NO_FATAL_FAILURE(use(surface, scope));
  auto picture = scenes::flat(scope, 200, 10, 10);
  painter_->upload(picture.descriptor());
  painter_->paint(scenes::whole(surface_, {}), 1);
  std::size_t near = 0, far = 0;
  for_each_painted([&](const Eigen::Vector3d& p, const std::uint8_t*) {
    if (p.z() < 20) {
      ++near;
    } else {
      ++far;
      EXPECT_FALSE(std::abs(p.x()) < 6 && std::abs(p.y()) < 6) << "in the plate's shadow: " << p.transpose();
    }
  });
  EXPECT_GT(near, 600u);
  EXPECT_GT(far, 5'000u);
}

TEST_F(PainterTest, PaintsOnlyTheSideThatItIsToldIsSeen) {
  const ScopeModel scope = scenes::scope();
  auto picture = scenes::flat(scope, 0, 200, 0);
  const Pose<M, C> from_centre{};  // inside a sphere about the origin
  ASSERT_NO_FATAL_FAILURE(use(scenes::sphere({0, 0, 0}, 15, 24), scope, 0.3, SeenFrom::inside));
  painter_->upload(picture.descriptor());
  painter_->paint(scenes::whole(surface_, from_centre), 1);
  EXPECT_GT(for_each_painted([](const Eigen::Vector3d& p, const std::uint8_t*) { EXPECT_GT(p.z(), 0); }),
            1000u);
  ASSERT_NO_FATAL_FAILURE(use(scenes::sphere({0, 0, 0}, 15, 24), scope, 0.3, SeenFrom::outside));
  painter_->upload(picture.descriptor());
  painter_->paint(scenes::whole(surface_, from_centre), 1);
  EXPECT_EQ(for_each_painted([](const Eigen::Vector3d&, const std::uint8_t*) {}), 0u);
}

TEST_F(PainterTest, LetsTheNewestPictureWinAndGivesBackTheBytesBeforeIt) {
  const ScopeModel scope = scenes::scope();
  ASSERT_NO_FATAL_FAILURE(use(scenes::plane(20, 30, 10), scope));
  std::vector<std::vector<std::uint8_t>> after{painter_->read_back().rgba};
  for (std::uint32_t unit = 1; unit <= 16; ++unit) {
    auto picture = scenes::flat(scope, static_cast<std::uint8_t>(unit * 15),
                                static_cast<std::uint8_t>(255 - unit * 15), 77);
    painter_->upload(picture.descriptor());
    Pose<M, C> X_MC;
    X_MC.translation_mm = {std::sin(unit), std::cos(unit), 0};
    ASSERT_TRUE(painter_->paint(scenes::whole(surface_, X_MC), unit).painted);
    after.push_back(painter_->read_back().rgba);
    EXPECT_NE(after[unit], after[unit - 1]);
  }
  for (std::uint32_t unit = 16; unit >= 1; --unit) {
    ASSERT_TRUE(painter_->undo());
    ASSERT_EQ(painter_->read_back().rgba, after[unit - 1]) << "undoing unit " << unit;
  }
  EXPECT_FALSE(painter_->undo());
  for (std::uint32_t unit = 1; unit <= 16; ++unit) {
    ASSERT_TRUE(painter_->redo());
    ASSERT_EQ(painter_->read_back().rgba, after[unit]) << "redoing unit " << unit;
  }
}

TEST_F(PainterTest, UndoesAStreamAsOne) {
  const ScopeModel scope = scenes::scope();
  ASSERT_NO_FATAL_FAILURE(use(scenes::plane(20, 60, 20), scope));
  const auto empty = painter_->read_back().rgba;
  for (int i = 0; i < 5; ++i) {
    auto picture = scenes::flat(scope, static_cast<std::uint8_t>(50 * i), 0, 0);
    painter_->upload(picture.descriptor());
    Pose<M, C> X_MC;
    X_MC.translation_mm = {4.0 * i - 8, 0, 0};
    painter_->paint(scenes::whole(surface_, X_MC), 7);
  }
  EXPECT_NE(painter_->read_back().rgba, empty);
  EXPECT_TRUE(painter_->undo());
  EXPECT_EQ(painter_->read_back().rgba, empty);
  EXPECT_FALSE(painter_->undo());
}

TEST_F(PainterTest, CountsCoverageAsTheCpuWould) {
  const ScopeModel scope = scenes::scope();
  ASSERT_NO_FATAL_FAILURE(use(scenes::plane(20, 40, 10), scope));
  EXPECT_EQ(painter_->coverage(), 0);
  auto picture = scenes::flat(scope, 9, 9, 9);
  painter_->upload(picture.descriptor());
  painter_->paint(scenes::whole(surface_, {}), 1);
  const AtlasPicture atlas = painter_->read_back();
  std::size_t own = 0, painted = 0;
  for (std::size_t i = 0; i < layout_.owners.size(); ++i) {
    own += layout_.inside[i];
    painted += layout_.inside[i] != 0 && atlas.rgba[4 * i + 3] > 0;
  }
  EXPECT_NEAR(painter_->coverage(), double(painted) / double(own), 1e-9);
  painter_->undo();
  EXPECT_EQ(painter_->coverage(), 0);
}

TEST_F(PainterTest, RefusesAPictureOfAnotherSize) {
  const ScopeModel scope = scenes::scope();
  ASSERT_NO_FATAL_FAILURE(use(scenes::plane(20, 26, 4), scope));
  ScopeModel other = scope;
  other.width_px = 320;
  auto picture = scenes::flat(other, 1, 2, 3);
  EXPECT_FALSE(painter_->upload(picture.descriptor()));
  EXPECT_FALSE(painter_->paint(scenes::whole(surface_, {}), 1).painted) << "nothing was ever uploaded";
}

/// One picture in several formats must give the same colours.
TEST_F(PainterTest, ReadsEveryFormatAsTheSameColours) {
  const ScopeModel scope = scenes::scope();
  ASSERT_NO_FATAL_FAILURE(use(scenes::plane(20, 26, 6), scope));
  const std::uint8_t y = 130, cb = 100, cr = 170;  // R 199.8, G 105.0, B 76.3 by BT.601
  const auto pixels = static_cast<std::size_t>(scope.width_px * scope.height_px);
  std::vector<std::uint8_t> yuyv, uyvy, nv12(pixels, y);
  for (std::size_t i = 0; i < pixels / 2; ++i) {
    yuyv.insert(yuyv.end(), {y, cb, y, cr});
    uyvy.insert(uyvy.end(), {cb, y, cr, y});
  }
  for (std::size_t i = 0; i < pixels / 4; ++i) nv12.insert(nv12.end(), {cb, cr});
  const auto colour_of = [&](std::vector<std::uint8_t>& bytes, PixelFormat format) {
    painter_->clear();
    painter_->upload(
        packed_image(reinterpret_cast<std::byte*>(bytes.data()), format, scope.width_px, scope.height_px));
    painter_->paint(scenes::whole(surface_, {}), 1);
    std::array<int, 3> colour{};
    for_each_painted([&](const Eigen::Vector3d&, const std::uint8_t* rgba) {
      colour = {rgba[0], rgba[1], rgba[2]};
    });
    return colour;
  };
  for (const auto& colour : {colour_of(yuyv, PixelFormat::yuyv), colour_of(uyvy, PixelFormat::uyvy),
                             colour_of(nv12, PixelFormat::nv12)}) {
    EXPECT_NEAR(colour[0], 200, 1);
    EXPECT_NEAR(colour[1], 110, 1);
    EXPECT_NEAR(colour[2], 76, 1);
  }
}

}  // namespace
}  // namespace orcart
