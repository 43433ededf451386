// The driver and the processor's vector units paint the same: the same texels, colours and records.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <Eigen/Geometry>

#include "render/atlas/painter.hpp"
#include "render/egl/context.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

/// A wall with two spheres before it, which hide and have edges, and with a corner behind the scope.
Surface room() {
  Surface surface = scenes::plane(30, 90, 24);
  scenes::append(surface, scenes::sphere({4, 3, 18}, 5, 14));
  scenes::append(surface, scenes::sphere({-7, -2, 12}, 2, 10));
  Surface beside = scenes::plane(9, 60, 1);
  for (Eigen::Vector3f& v : beside.mesh.vertices_mm) v = Eigen::Vector3f(14.0F, v.y(), v.x() + 9);
  scenes::append(surface, beside);
  return surface;
}

struct Painted {
  AtlasPicture picture;
  AtlasRecords records;
};

/// One painter of each kind on the same surface.
class BothPainters {
 public:
  BothPainters(const ScopeModel& scope, PainterSettings settings, double texel_mm = 0.15)
      : layout_(std::move(*build_atlas(surface_.mesh, {.texel_mm = texel_mm}))), scope_(scope) {
    for (const PaintBy by : {PaintBy::gpu, PaintBy::processor}) {
      settings.paint_by = by;
      painters_.push_back(std::move(*Painter::create(surface_, layout_, scope, settings)));
    }
  }

  template <class Act>
  void each(Act act) {
    for (Painter& painter : painters_) act(painter);
  }

  void view(const ImageDescriptor& picture, const Pose<M, C>& X_MC, std::uint32_t unit) {
    each([&](Painter& painter) {
      ASSERT_TRUE(painter.upload(picture));
      PaintReport report = painter.paint(scenes::whole(surface_, X_MC), unit);
      EXPECT_TRUE(report.painted);
      while (report.carried) report = painter.paint_more();
    });
  }

  /// But for a few texels: numbers lie on the border between two, and drivers mix a picture's levels
  /// coarsely.
  void expect_alike() const {
    const Painted a = read(0), b = read(1);
    std::size_t painted = 0, other_texels = 0, other_colours = 0, other_records = 0;
    for (std::size_t i = 0; i < a.records.texels.size(); ++i) {
      const TexelRecord &x = a.records.texels[i], &y = b.records.texels[i];
      if (x.capture == 0 && y.capture == 0) continue;
      ++painted;
      other_texels += x.capture != y.capture ? 1U : 0U;
      if (x.capture != y.capture) continue;
      other_colours += farthest_apart(&a.picture.rgba[4 * i], &b.picture.rgba[4 * i]) > 4 ? 1U : 0U;
      other_records += std::abs(x.angle_cdeg - y.angle_cdeg) > 3 ||
                               std::abs(x.footprint_um - y.footprint_um) > 1 ||
                               std::abs(x.error_um - y.error_um) > 1
                           ? 1U
                           : 0U;
    }
    EXPECT_GT(painted, 4'000U);
    EXPECT_LT(other_texels, painted / 500) << "of " << painted;
    EXPECT_LT(other_colours, painted / 500) << "of " << painted;
    EXPECT_LT(other_records, painted / 500) << "of " << painted;
  }

 private:
  Painted read(std::size_t painter) const {
    return {painters_[painter].read_back(), painters_[painter].read_records()};
  }
  /// Levels, of the colours as they are kept, premultiplied: of faint paint the rest is rounding.
  static double farthest_apart(const std::uint8_t* a, const std::uint8_t* b) {
    double most = std::abs(a[3] - b[3]);
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a[c] - b[c]) * a[3] / 255.0);
    return most;
  }

  GlContext context_{std::move(*GlContext::create())};
  Surface surface_ = room();
  AtlasLayout layout_;
  ScopeModel scope_;
  std::vector<Painter> painters_;
};

Pose<M, C> looking(double x_mm, double turn_rad) {
  Pose<M, C> X_MC;
  X_MC.translation_mm.x() = x_mm;
  X_MC.rotation = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(0.3, 1, 0.2).normalized()).toRotationMatrix();
  return X_MC;
}

/// Smooth, with a white spot.
scenes::Rgba picture_of(const ScopeModel& scope, int number) {
  scenes::Rgba picture{scope.width_px, scope.height_px, {}};
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x) {
      const double shine = 200 * std::exp(-(std::pow(x - 300.0, 2) + std::pow(y - 200.0, 2)) / 900);
      const auto level = [&](double of) {
        return static_cast<std::uint8_t>(std::clamp(of + shine, 0.0, 255.0));
      };
      picture.bytes.insert(picture.bytes.end(),
                           {level(110 + 60 * std::sin(x / 40.0 + number)),
                            level(90 + 50 * std::sin(y / 30.0)), level(60 + number), 255});
    }
  return picture;
}

void paint_three_views(BothPainters& both, const ScopeModel& scope) {
  for (std::uint32_t unit = 1; unit <= 3; ++unit) {
    scenes::Rgba picture = picture_of(scope, static_cast<int>(unit) * 20);
    both.view(picture.descriptor(), looking(4.0 * unit - 6, 0.12 * unit - 0.2), unit);
  }
}

class PaintByModel : public ::testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(Models, PaintByModel,
                         ::testing::Values(LensModel::brown, LensModel::poly4, LensModel::fisheye));

TEST_P(PaintByModel, DriverAndProcessorPaintTheSame) {
  const ScopeModel scope = scenes::scope(GetParam());
  BothPainters both(scope, {});
  paint_three_views(both, scope);
  both.expect_alike();
}

TEST(PaintBy, EveryChoiceIsTheSame) {
  ScopeModel scope = scenes::scope();
  scope.notch_rad = 0.7;
  scope.fall_off = {.reference_mm = 20, .vignetting_cos_power = 2.5};
  for (const LightModel light : {LightModel::fixed_exposure, LightModel::auto_exposure}) {
    BothPainters both(scope, {.policy = PaintPolicy::best, .highlights = Highlights::yield, .light = light});
    both.each([](Painter& painter) {
      painter.set_turn(0.4);
      painter.set_view_error({.position_mm = 0.3F, .angle_rad = 0.004F, .pixels = 0.6F});
    });
    paint_three_views(both, scope);
    both.expect_alike();
  }
}

TEST(PaintBy, CoarserLevelsAreTheSame) {
  const ScopeModel scope = scenes::scope();
  BothPainters both(scope, {.policy = PaintPolicy::best}, 0.6);  // a texel covers many pixels
  both.each([](Painter& painter) { painter.set_view_error({.position_mm = 0.2F}); });
  paint_three_views(both, scope);
  both.expect_alike();
}

/// As fine as texels are wide, where one level is not like the next.
TEST(PaintBy, FineGrainIsAveragedTheSame) {
  const ScopeModel scope = scenes::scope();
  scenes::Rgba picture{scope.width_px, scope.height_px, {}};
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x) {
      const auto level = static_cast<std::uint8_t>(x / 3 % 3 == 0 && y / 3 % 3 == 0 ? 190 : 90);
      picture.bytes.insert(picture.bytes.end(), {level, level, level, 255});
    }
  for (const double texel_mm : {0.15, 0.25}) {
    BothPainters both(scope, {}, texel_mm);
    both.view(picture.descriptor(), looking(0, 0.1), 1);
    both.expect_alike();
  }
}

TEST(PaintBy, StepsOfAFewCellsAreTheSame) {
  const ScopeModel scope = scenes::scope();
  BothPainters both(scope, {.max_texels_per_step = 5'000});
  paint_three_views(both, scope);
  both.expect_alike();
}

TEST(PaintBy, AfterUndoRedoAndClearingTheSameIsPaintedOn) {
  const ScopeModel scope = scenes::scope();
  BothPainters both(scope, {.policy = PaintPolicy::best});
  paint_three_views(both, scope);
  both.each([](Painter& painter) {
    painter.undo();
    painter.undo();
    painter.redo();
  });
  scenes::Rgba picture = picture_of(scope, 5);
  both.view(picture.descriptor(), looking(1, 0.1), 4);
  both.expect_alike();
  both.each([](Painter& painter) { painter.clear(); });
  paint_three_views(both, scope);
  both.expect_alike();
}

/// What this processor has and less: carts have other ones.
TEST(PaintBy, EveryWidthOfVectorsIsTheSame) {
  const ScopeModel scope = scenes::scope();
  int tried = 0;
  for (const std::int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4, HWY_SSSE3, HWY_NEON, HWY_SCALAR}) {
    hwy::SetSupportedTargetsForTest(0);
    if ((hwy::SupportedTargets() & target) == 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    BothPainters both(scope, {.policy = PaintPolicy::best}, 0.3);
    scenes::Rgba picture = picture_of(scope, 3);
    both.view(picture.descriptor(), looking(2, 0.1), 1);
    both.expect_alike();
    ++tried;
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GT(tried, 0);
}

class PaintByFormat : public ::testing::TestWithParam<PixelFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, PaintByFormat,
                         ::testing::Values(PixelFormat::nv12, PixelFormat::yuyv, PixelFormat::uyvy,
                                           PixelFormat::gray8));

TEST_P(PaintByFormat, EveryFormatIsTheSame) {
  const ScopeModel scope = scenes::scope();
  for (const double texel_mm : {0.15, 0.5}) {
    BothPainters both(scope, {}, texel_mm);
    std::vector<std::byte> bytes(packed_bytes(GetParam(), scope.width_px, scope.height_px));
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::byte>(std::lround(128 + 80 * std::sin(static_cast<double>(i % 640) / 50) +
                                                    30 * std::sin(static_cast<double>(i) / 64'000)));
    both.view(packed_image(bytes.data(), GetParam(), scope.width_px, scope.height_px), looking(0, 0.05), 1);
    both.expect_alike();
  }
}

}  // namespace
}  // namespace orcart
