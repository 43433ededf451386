// What is kept of each texel, which picture wins, what becomes of highlights, light and fine detail.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "render/atlas/colouring.hpp"
#include "render/atlas/painter.hpp"
#include "render/egl/context.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

/// A context, a surface and a painter that live together.
struct Bench {
  GlContext context;
  Surface surface;
  ScopeModel scope;
  AtlasLayout layout;
  std::unique_ptr<Painter> painter;

  Bench(Surface painted, ScopeModel with, const PainterSettings& settings = {}, double texel_mm = 0.2)
      : context(std::move(*GlContext::create())),
        surface(std::move(painted)),
        scope(std::move(with)),
        layout(std::move(*build_atlas(surface.mesh, {.texel_mm = texel_mm}))) {
    painter = std::make_unique<Painter>(
        std::move(*Painter::create(surface, layout, scope, scenes::painted_by(settings))));
  }

  void paint(scenes::Rgba picture, const Pose<M, C>& X_MC, std::uint32_t unit) const {
    ASSERT_TRUE(painter->upload(picture.descriptor()));
    ASSERT_TRUE(painter->paint(scenes::whole(surface, X_MC), unit).painted);
  }

  /// visit(point, rgba, record) for the painted texels of triangles.
  template <class Visit>
  std::size_t for_each_painted(Visit visit) const {
    const AtlasPicture picture = painter->read_back();
    const AtlasRecords records = painter->read_records();
    std::size_t count = 0;
    for (std::size_t i = 0; i < layout.owners.size(); ++i) {
      if (layout.inside[i] == 0 || picture.rgba[4 * i + 3] == 0) continue;
      visit(scenes::point_of(surface, layout, i), &picture.rgba[4 * i], records.texels[i]);
      ++count;
    }
    return count;
  }
};

Pose<M, C> back_by(double mm) {
  Pose<M, C> X_MC;
  X_MC.translation_mm.z() = -mm;
  return X_MC;
}

std::vector<TexelRecord> records_of(const Bench& bench) {
  return bench.painter->read_records().texels;
}

bool same(const std::vector<TexelRecord>& a, const std::vector<TexelRecord>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(TexelRecord)) == 0;
}

TEST(PainterRecords, HoldCaptureAngleFootprintAndPredictedErrorOfEachTexel) {
  Bench bench(scenes::plane(20, 24, 8), scenes::scope());
  bench.painter->set_view_error({.position_mm = 0.3F, .angle_rad = 0.01F, .pixels = 0.5F});
  bench.paint(scenes::flat(bench.scope, 90, 90, 90), {}, 7);
  const std::size_t painted = bench.for_each_painted([&](const Eigen::Vector3d& p, const auto*,
                                                         const TexelRecord& record) {
    const double distance = p.norm(), cosine = p.z() / distance, across = distance / bench.scope.lens.fx_px;
    EXPECT_EQ(record.capture, 7);
    EXPECT_NEAR(record.angle_cdeg / 100.0, std::acos(cosine) * 180 / M_PI, 0.12);
    EXPECT_NEAR(record.footprint_um, 1000 * across / cosine, 1.5);
    // Of the two axes across the line of sight one is stretched by the slant.
    EXPECT_NEAR(
        record.error_um,
        1000 * std::hypot(0.3, 0.01 * distance, 0.5 * across) * std::sqrt((1 + 1 / (cosine * cosine)) / 2),
        3);
  });
  EXPECT_GT(painted, 5'000U);
}

TEST(PainterRecords, AreBareWhereNothingWasPaintedAndAfterClear) {
  Bench bench(scenes::plane(20, 60, 8), scenes::scope());
  bench.paint(scenes::flat(bench.scope, 90, 90, 90), {}, 1);
  const AtlasPicture picture = bench.painter->read_back();
  const auto records = records_of(bench);
  for (std::size_t i = 0; i < records.size(); ++i)
    EXPECT_EQ(records[i].capture != 0, picture.rgba[4 * i + 3] != 0);
  bench.painter->clear();
  for (const TexelRecord& record : records_of(bench)) EXPECT_EQ(record.capture, 0);
}

TEST(PainterRecords, AreUndoneAndRedoneToTheByteThroughSixteenCaptures) {
  for (const PaintPolicy policy : {PaintPolicy::newest, PaintPolicy::best}) {
    Bench bench(scenes::plane(20, 30, 10), scenes::scope(), {.policy = policy});
    std::vector<std::vector<TexelRecord>> after{records_of(bench)};
    std::vector<std::vector<std::uint8_t>> colours{bench.painter->read_back().rgba};
    for (std::uint32_t unit = 1; unit <= 16; ++unit) {
      Pose<M, C> X_MC = back_by(5 * std::sin(unit));
      X_MC.translation_mm.x() = 3 * std::cos(unit);
      bench.paint(scenes::flat(bench.scope, static_cast<std::uint8_t>(12 * unit), 80, 90), X_MC, unit);
      after.push_back(records_of(bench));
      colours.push_back(bench.painter->read_back().rgba);
    }
    for (std::uint32_t unit = 16; unit >= 1; --unit) {
      ASSERT_TRUE(bench.painter->undo());
      ASSERT_TRUE(same(records_of(bench), after[unit - 1])) << "undoing " << unit;
      ASSERT_EQ(bench.painter->read_back().rgba, colours[unit - 1]);
    }
    for (std::uint32_t unit = 1; unit <= 16; ++unit) {
      ASSERT_TRUE(bench.painter->redo());
      ASSERT_TRUE(same(records_of(bench), after[unit])) << "redoing " << unit;
      ASSERT_EQ(bench.painter->read_back().rgba, colours[unit]);
    }
  }
}

TEST(PaintPolicy, BestKeepsTheFinerPictureWhicheverComesFirst) {
  for (const bool near_first : {true, false}) {
    Bench bench(scenes::plane(20, 12, 6), scenes::scope(), {.policy = PaintPolicy::best});
    const auto near = [&] { bench.paint(scenes::flat(bench.scope, 200, 0, 0), {}, 1); };
    const auto far = [&] { bench.paint(scenes::flat(bench.scope, 0, 0, 200), back_by(15), 2); };
    near_first ? (near(), far()) : (far(), near());
    bench.for_each_painted([&](const Eigen::Vector3d&, const auto* rgba, const TexelRecord& record) {
      EXPECT_EQ(record.capture, 1);
      EXPECT_GE(rgba[0], 199);
      EXPECT_LE(rgba[2], 1);
    });
  }
}

TEST(PaintPolicy, BestTakesTheViewThatLooksStraighterAndJoinsTheTwoSoftly) {
  Bench bench(scenes::plane(20, 30, 10), scenes::scope(), {.policy = PaintPolicy::best});
  Pose<M, C> left, right;
  left.translation_mm.x() = -5;
  right.translation_mm.x() = 5;
  bench.paint(scenes::flat(bench.scope, 200, 0, 0), left, 1);
  bench.paint(scenes::flat(bench.scope, 0, 0, 200), right, 2);
  std::size_t mixed = 0;
  bench.for_each_painted([&](const Eigen::Vector3d& p, const auto* rgba, const TexelRecord&) {
    if (std::abs(p.y()) > 6 || std::abs(p.x()) > 8) return;
    if (p.x() < -4) {
      EXPECT_GT(rgba[0], 190) << p.transpose();
    }
    if (p.x() > 4) {
      EXPECT_GT(rgba[2], 190) << p.transpose();
    }
    mixed += rgba[0] > 40 && rgba[2] > 40 ? 1 : 0;
  });
  EXPECT_GT(mixed, 200U);
}

TEST(PaintPolicy, NewestSaysWhoseColourPrevailsAtTheSoftRim) {
  Bench bench(scenes::plane(20, 40, 10), scenes::scope());
  Pose<M, C> beside;
  beside.translation_mm.x() = 8;
  bench.paint(scenes::flat(bench.scope, 200, 0, 0), {}, 1);
  bench.paint(scenes::flat(bench.scope, 0, 0, 200), beside, 2);
  bench.for_each_painted([&](const Eigen::Vector3d&, const auto* rgba, const TexelRecord& record) {
    if (rgba[3] != 255) return;
    if (rgba[0] > 110) {
      EXPECT_EQ(record.capture, 1);
    }
    if (rgba[2] > 110) {
      EXPECT_EQ(record.capture, 2);
    }
  });
}

/// Grey with a white spot of 40 pixels about the middle.
scenes::Rgba with_highlight(const ScopeModel& scope, std::uint8_t grey) {
  scenes::Rgba picture = scenes::flat(scope, grey, grey / 2, grey / 3);
  for (int y = 218; y < 259; ++y)
    for (int x = 302; x < 343; ++x)
      std::fill_n(&picture.bytes[4 * static_cast<std::size_t>(y * scope.width_px + x)], 3, std::uint8_t{255});
  return picture;
}

std::size_t white_texels(const Bench& bench) {
  std::size_t white = 0;
  bench.for_each_painted([&](const auto&, const auto* rgba, const auto&) { white += rgba[2] > 200 ? 1 : 0; });
  return white;
}

TEST(Highlights, NeverCoverAPictureAndGiveWayToAny) {
  for (const PaintPolicy policy : {PaintPolicy::newest, PaintPolicy::best}) {
    Bench bench(scenes::plane(20, 20, 8), scenes::scope(),
                {.policy = policy, .highlights = Highlights::yield});
    bench.paint(with_highlight(bench.scope, 150), {}, 1);
    EXPECT_GT(white_texels(bench), 80U) << "better than a hole while nothing else is known";
    bench.paint(scenes::flat(bench.scope, 150, 75, 50), back_by(4), 2);
    EXPECT_EQ(white_texels(bench), 0U);
    bench.paint(with_highlight(bench.scope, 150), back_by(2), 3);
    EXPECT_EQ(white_texels(bench), 0U);
  }
}

TEST(Highlights, ArePaintedAsAnythingElseWhereTheyAreKept) {
  Bench bench(scenes::plane(20, 20, 8), scenes::scope(), {.highlights = Highlights::keep});
  bench.paint(scenes::flat(bench.scope, 150, 75, 50), {}, 1);
  bench.paint(with_highlight(bench.scope, 150), {}, 2);
  EXPECT_GT(white_texels(bench), 80U);
}

/// Columns of one pixel, black and white in turn.
scenes::Rgba stripes(const ScopeModel& scope) {
  scenes::Rgba picture = scenes::flat(scope, 0, 0, 0);
  for (int i = 0; i < scope.width_px * scope.height_px; i += 2)
    std::fill_n(&picture.bytes[4 * static_cast<std::size_t>(i)], 3, std::uint8_t{255});
  return picture;
}

TEST(PaintFilter, AveragesWhatIsFinerThanATexelInsteadOfPickingFromIt) {
  // At 6 mm a texel of 0.3 mm covers 17 pixels: stripes of one pixel are grey, not stripes of another width.
  Bench bench(scenes::plane(6, 6, 4), scenes::scope(), {}, 0.3);
  bench.paint(stripes(bench.scope), {}, 1);
  std::size_t averaged = 0;
  bench.for_each_painted([&](const Eigen::Vector3d& p, const auto* rgba, const auto&) {
    if (std::max(std::abs(p.x()), std::abs(p.y())) > 2.3) return;  // beside the edge nothing is averaged
    EXPECT_NEAR(rgba[0], 128, 4);
    ++averaged;
  });
  EXPECT_GT(averaged, 150U);
}

TEST(PaintFilter, RunsSmoothlyBetweenPixelsThatCoverManyTexels) {
  // At 55 mm a pixel covers 0.16 mm, four texels of 0.04: a ramp of two levels a pixel must not climb in
  // steps.
  ScopeModel scope = scenes::scope();
  Bench bench(scenes::plane(55, 6, 2), scope, {}, 0.04);
  scenes::Rgba ramp = scenes::flat(scope, 0, 0, 0);
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 280; x < 366; ++x)
      ramp.bytes[4 * static_cast<std::size_t>(y * scope.width_px + x)] =
          static_cast<std::uint8_t>(3 * (x - 280));
  bench.paint(ramp, {}, 1);
  const std::size_t painted =
      bench.for_each_painted([&](const Eigen::Vector3d& p, const auto* rgba, const auto&) {
        const double at = project(scope.lens, p)->x();
        if (at > 282 && at < 362) {
          EXPECT_NEAR(rgba[0], 3 * (at - 280), 0.9);
        }
      });
  EXPECT_GT(painted, 10'000U);
}

/// What a camera beside its light makes of a grey plane: the light's fall, at a gain that gives the picture
/// its mean.
scenes::Rgba lit_plane(const Bench& bench, const Pose<M, C>& X_MC, double mean_grey) {
  const ScopeModel& scope = bench.scope;
  std::vector<double> light(static_cast<std::size_t>(scope.width_px * scope.height_px), 0);
  double sum = 0, count = 0;
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x) {
      const auto direction = direction_of(scope.lens, {x, y});
      if (!direction || std::hypot(x - scope.mask.cx_px, y - scope.mask.cy_px) > scope.mask.radius_px)
        continue;
      const double cosine = direction->z(), distance = (20 - X_MC.translation_mm.z()) / cosine;
      const double linear = std::pow(20 / distance, 2) *
                            std::pow(cosine, scope.fall_off.vignetting_cos_power) * (cosine + 0.2) / 1.2;
      sum += light[static_cast<std::size_t>(y * scope.width_px + x)] = std::pow(linear, 1 / 2.2);
      ++count;
    }
  scenes::Rgba picture = scenes::flat(scope, 0, 0, 0);
  for (std::size_t i = 0; i < light.size(); ++i)
    std::fill_n(&picture.bytes[4 * i], 3,
                static_cast<std::uint8_t>(std::lround(std::min(255.0, light[i] * mean_grey * count / sum))));
  return picture;
}

TEST(Light, IsEvenedOutWithinAPictureAndBetweenDistancesWhereTheCameraSetsItsGain) {
  ScopeModel scope = scenes::scope();
  scope.fall_off = {.reference_mm = 20, .vignetting_cos_power = 3};
  Bench bench(scenes::plane(20, 80, 40), scope, {.light = LightModel::auto_exposure});
  for (const double back_mm : {0.0, 12.0}) {
    bench.painter->clear();
    bench.paint(lit_plane(bench, back_by(back_mm), 110), back_by(back_mm), 1);
    int least = 255, most = 0;
    bench.for_each_painted([&](const Eigen::Vector3d& p, const auto* rgba, const auto&) {
      const Eigen::Vector3d p_C = p + Eigen::Vector3d(0, 0, back_mm);
      if (rgba[3] != 255 || p_C.head<2>().norm() / p_C.z() > 0.6) return;
      least = std::min<int>(least, rgba[0]);
      most = std::max<int>(most, rgba[0]);
    });
    EXPECT_LE(most - least, 6) << "at " << 20 + back_mm << " mm";
    EXPECT_NEAR((least + most) / 2.0, 110, 8) << "at " << 20 + back_mm << " mm";
  }
}

TEST(Colouring, GivesEachTexelTheColourOfWhatIsKnownOfIt) {
  AtlasPicture painting{
      .width_texels = 3, .height_texels = 1, .rgba = {1, 2, 3, 255, 1, 2, 3, 255, 1, 2, 3, 0}};
  const AtlasRecords records{
      .width_texels = 3, .height_texels = 1, .texels = {{1, 0, 0, 0}, {2, 8000, 500, 2000}, {0, 0, 0, 0}}};
  for (const ColourBy by : {ColourBy::angle, ColourBy::resolution, ColourBy::error}) {
    const AtlasPicture shown = coloured(painting, records, by);
    EXPECT_EQ(std::vector(shown.rgba.begin(), shown.rgba.begin() + 3),
              (std::vector<std::uint8_t>{253, 231, 37}));
    EXPECT_EQ(std::vector(shown.rgba.begin() + 4, shown.rgba.begin() + 7),
              (std::vector<std::uint8_t>{68, 1, 84}));
    EXPECT_EQ(shown.rgba[11], 0);
  }
  const AtlasPicture by_capture = coloured(painting, records, ColourBy::capture);
  EXPECT_FALSE(std::equal(by_capture.rgba.begin(), by_capture.rgba.begin() + 3, by_capture.rgba.begin() + 4));
  EXPECT_EQ(coloured(painting, records, ColourBy::picture).rgba, painting.rgba);
}

}  // namespace
}  // namespace orcart
