// Paper mode against its closed form, a soft mask over older paint, and what a capture may cost the next one.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "realtime/mapper/paper_coordinates.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "render/atlas/painter.hpp"
#include "render/egl/context.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

/// A context, a surface and a painter that live together.
struct Stage {
  GlContext context;
  Surface surface;
  AtlasLayout layout;
  std::unique_ptr<Painter> painter;

  Stage(Surface painted, const ScopeModel& scope, const PainterSettings& settings = {}, double texel_mm = 0.2)
      : context(std::move(*GlContext::create())),
        surface(std::move(painted)),
        layout(std::move(*build_atlas(surface.mesh, {.texel_mm = texel_mm}))) {
    painter = std::make_unique<Painter>(
        std::move(*Painter::create(surface, layout, scope, scenes::painted_by(settings))));
  }

  template <class Visit>
  std::size_t for_each_texel(Visit visit) const {
    const AtlasPicture picture = painter->read_back();
    std::size_t count = 0;
    for (std::size_t i = 0; i < layout.owners.size(); ++i) {
      if (layout.inside[i] == 0 || picture.rgba[4 * i + 3] == 0) continue;
      visit(i, scenes::point_of(surface, layout, i), picture.rgba.data() + 4 * i);
      ++count;
    }
    return count;
  }
};

/// The plane z = depth as the five rays see it.
PaperProjection paper_on_plane(double depth_mm, double cone_half_angle_rad) {
  PaperProjection paper;
  paper.valid = true;
  paper.up = -Eigen::Vector3f::UnitY();
  paper.half_width_slope = static_cast<float>(std::tan(cone_half_angle_rad));
  paper.s_size_mm = paper.t_size_mm = static_cast<float>(2 * depth_mm * std::tan(cone_half_angle_rad));
  return paper;
}

double worst_error_px(const Stage& stage, const ScopeModel& scope, const PaperProjection& paper) {
  double worst_px = 0;
  stage.for_each_texel([&](std::size_t i, const Eigen::Vector3d&, const std::uint8_t* rgba) {
    if (rgba[3] != 255) return;
    const TexelOwner& owner = stage.layout.owners[i];
    std::array<Eigen::Vector2f, 3> st;
    for (std::size_t c = 0; c < 3; ++c) {
      st[c] = paper_coordinates(
          paper, stage.surface.mesh.vertices_mm[stage.surface.mesh.triangles[owner.triangle][c]]);
    }
    const Eigen::Vector2d at =
        (st[0] + owner.b1 * (st[1] - st[0]) + owner.b2 * (st[2] - st[0])).cast<double>();
    const double slope = paper.half_width_slope;
    const auto pixel = project(scope.lens, {(2 * at.x() - 1) * slope, (1 - 2 * at.y()) * slope, 1});
    worst_px = std::max(worst_px, std::abs(rgba[0] * 639.0 / 255 - pixel->x()));
    worst_px = std::max(worst_px, std::abs(rgba[1] * 479.0 / 255 - pixel->y()));
  });
  return worst_px;
}

TEST(PainterInPaperMode, FollowsTheClosedFormOnAPlane) {
  const ScopeModel scope = scenes::scope();
  Stage stage(scenes::plane(20, 24, 9), scope, {}, 0.055);  // a texel is finer than a pixel
  auto ramp = scenes::ramp(scope);
  stage.painter->upload(ramp.descriptor());
  CutoutPatch patch = scenes::whole(stage.surface, {}, TextureMode::paper);
  patch.paper = paper_on_plane(20, scope.cone_half_angle_rad);
  ASSERT_TRUE(stage.painter->paint(patch, 1).painted);
  EXPECT_GT(stage.for_each_texel([](std::size_t, const auto&, const auto*) {}), 8'000u);
  EXPECT_LT(worst_error_px(stage, scope, patch.paper), 2.6) << "a level of the ramp is 2.5 px wide";
}

TEST(PainterInPaperMode, PaintsWholeTrianglesOfTheCutoutAndNoOthers) {
  const ScopeModel scope = scenes::scope();
  Stage stage(scenes::plane(20, 24, 9), scope);
  auto picture = scenes::flat(scope, 10, 200, 30);
  stage.painter->upload(picture.descriptor());
  CutoutPatch patch(4);
  patch.mode = TextureMode::paper;
  patch.paper = paper_on_plane(20, scope.cone_half_angle_rad);
  patch.triangles = {80, 81};
  stage.painter->paint(patch, 1);
  const std::size_t painted = stage.for_each_texel([&](std::size_t i, const auto&, const auto*) {
    const std::uint32_t triangle = stage.layout.owners[i].triangle;
    EXPECT_TRUE(triangle == 80 || triangle == 81);
  });
  EXPECT_NEAR(static_cast<double>(painted), std::pow(24.0 / 9 / 0.2, 2), 20);
}

TEST(PainterInPaperMode, RefusesAViewWhoseCentreRayMissed) {
  const ScopeModel scope = scenes::scope();
  Stage stage(scenes::plane(20, 24, 4), scope);
  auto picture = scenes::flat(scope, 10, 200, 30);
  stage.painter->upload(picture.descriptor());
  EXPECT_FALSE(stage.painter->paint(scenes::whole(stage.surface, {}, TextureMode::paper), 1).painted);
}

/// How far inside the mask's circle a point of C is seen, pixels.
double rim_px(const ScopeModel& scope, const Eigen::Vector3d& p_C_mm) {
  const auto pixel = project(scope.lens, p_C_mm);
  if (!pixel) return -1;
  return scope.mask.radius_px -
         std::hypot(pixel->x() - scope.mask.cx_px,
                    (pixel->y() - scope.mask.cy_px) * scope.lens.fx_px / scope.lens.fy_px);
}

TEST(Painter, BlendsTheSoftRimOverOlderPaint) {
  const ScopeModel scope = scenes::scope();
  Stage stage(scenes::plane(20, 40, 10), scope);
  auto red = scenes::flat(scope, 200, 0, 0), blue = scenes::flat(scope, 0, 0, 200);
  Pose<M, C> beside;
  beside.translation_mm.x() = 8;
  stage.painter->upload(red.descriptor());
  stage.painter->paint(scenes::whole(stage.surface, {}), 1);
  stage.painter->upload(blue.descriptor());
  stage.painter->paint(scenes::whole(stage.surface, beside), 2);
  std::size_t mixed = 0;
  stage.for_each_texel([&](std::size_t, const Eigen::Vector3d& p, const std::uint8_t* rgba) {
    const double rim = rim_px(scope, p - beside.translation_mm), old_rim = rim_px(scope, p);
    if (old_rim < scope.mask.soft_edge_px) return;  // there was nothing to blend with, or little
    const double core = std::clamp(rim / scope.mask.radius_px / 0.2, 0.0, 1.0);
    if (rgba[3] != 255 || core == 0 || core == 1) return;
    const double weight = std::min(1.0, rim / scope.mask.soft_edge_px) * core * core * (3 - 2 * core);
    EXPECT_NEAR(rgba[2], 200 * weight, 6);
    EXPECT_NEAR(rgba[0], 200 * (1 - weight), 6);
    ++mixed;
  });
  EXPECT_GT(mixed, 200u);
}

// It would be a black tooth on the surface. One that sticks out of the circle takes nothing away.
TEST(Painter, LeavesADarkNotchUnpaintedAtEveryTurn) {
  ScopeModel scope = scenes::scope();
  scope.notch_rad = 0.7;
  scope.turning = Turning{.centre_px = {scope.mask.cx_px, scope.mask.cy_px}};
  struct Case {
    double turn_rad;
    bool dark;
  };
  for (const Case& each : {Case{0, true}, {2, true}, {2, false}}) {
    const TurnedOptics optics = optics_at(scope, each.turn_rad);
    const auto part_of_radius = [&](const Eigen::Vector2d& off) { return off.norm() / scope.mask.radius_px; };
    const auto beside_notch_rad = [&](const Eigen::Vector2d& off) {
      return std::abs(std::remainder(std::atan2(off.y(), off.x()) - 0.7 - each.turn_rad, 2 * M_PI));
    };
    const auto off_centre = [&](double x, double y) {
      return Eigen::Vector2d(x - optics.mask.cx_px,
                             (y - optics.mask.cy_px) * optics.lens.fx_px / optics.lens.fy_px);
    };
    auto picture = scenes::flat(scope, 100, 100, 100);
    for (int i = 0; each.dark && i < scope.width_px * scope.height_px; ++i) {
      const int x = i % scope.width_px, y = i / scope.width_px;
      const Eigen::Vector2d off = off_centre(x, y);
      if (part_of_radius(off) > 0.9 && beside_notch_rad(off) < 0.06)
        std::fill_n(&picture.bytes[4 * static_cast<std::size_t>(i)], 3, std::uint8_t{0});
    }
    Stage stage(scenes::plane(20, 40, 10), scope);
    stage.painter->upload(picture.descriptor());
    stage.painter->set_turn(each.turn_rad);
    stage.painter->paint(scenes::whole(stage.surface, {}), 1);
    const AtlasPicture atlas = stage.painter->read_back();
    std::size_t notched = 0, beside = 0;
    for (std::size_t i = 0; i < stage.layout.owners.size(); ++i) {
      if (stage.layout.inside[i] == 0) continue;
      const auto pixel = project(optics.lens, scenes::point_of(stage.surface, stage.layout, i));
      if (!pixel) continue;
      const Eigen::Vector2d off = off_centre(pixel->x(), pixel->y());
      const double part = part_of_radius(off), away_rad = beside_notch_rad(off);
      if (part > 0.97 || part < 0.5) continue;
      if (each.dark && part > 0.93 && away_rad < 0.04) {
        EXPECT_EQ(atlas.rgba[4 * i + 3], 0);
        ++notched;
      } else if (!each.dark || part < 0.87 || away_rad > 0.09) {
        EXPECT_NE(atlas.rgba[4 * i + 3], 0);
        ++beside;
      }
    }
    EXPECT_EQ(notched > 10, each.dark) << notched;
    EXPECT_GT(beside, 1000u);
  }
}

TEST(Painter, PaintsAnObliquePlaneWithoutHidingItFromItself) {
  ScopeModel scope = scenes::scope();
  scope.mask.radius_px = 400;
  for (const double tilt_rad : {-1.2, -0.9, 0.9, 1.2}) {
    Surface surface = scenes::plane(0, 60, 30);
    const Eigen::Matrix3f turn =
        (Eigen::AngleAxisf(static_cast<float>(tilt_rad), Eigen::Vector3f(1, -1, 0).normalized()))
            .toRotationMatrix();
    for (auto& v : surface.mesh.vertices_mm) v = turn * v + Eigen::Vector3f(0, 0, 25);
    Stage stage(std::move(surface), scope);
    auto picture = scenes::flat(scope, 100, 100, 100);
    stage.painter->upload(picture.descriptor());
    stage.painter->paint(scenes::whole(stage.surface, {}), 1);
    const AtlasPicture atlas = stage.painter->read_back();
    std::size_t seen = 0, missed = 0;
    for (std::size_t i = 0; i < stage.layout.owners.size(); ++i) {
      if (stage.layout.inside[i] == 0) continue;
      const Eigen::Vector3d p = scenes::point_of(stage.surface, stage.layout, i);
      const double cosine = std::abs((turn.col(2).cast<double>()).dot(p.normalized()));
      const bool at_rim =
          (turn.transpose() * (p.cast<float>() - Eigen::Vector3f(0, 0, 25))).head<2>().cwiseAbs().maxCoeff() >
          28;
      const bool in_view = !at_rim && p.z() > 1 && p.norm() < 59 &&
                           std::atan2(p.head<2>().norm(), p.z()) < 0.66 && cosine > 0.18;
      seen += in_view;
      missed += in_view && atlas.rgba[4 * i + 3] == 0;
    }
    EXPECT_GT(seen, 1'000u) << tilt_rad;
    EXPECT_EQ(missed, 0u) << tilt_rad;
  }
}

TEST(Painter, CarriesWhatIsMoreThanOneStepMayPaint) {
  const ScopeModel scope = scenes::scope();
  Stage whole(scenes::plane(20, 40, 10), scope),
      carried(scenes::plane(20, 40, 10), scope, {.max_texels_per_step = 4096});
  auto ramp = scenes::ramp(scope);
  ASSERT_TRUE(carried.context.make_current());
  carried.painter->upload(ramp.descriptor());
  PaintReport report = carried.painter->paint(scenes::whole(carried.surface, {}), 1);
  int steps = 1;
  for (; report.carried; ++steps) {
    EXPECT_LE(report.texels, 4096u);
    report = carried.painter->paint_more();
  }
  EXPECT_GT(steps, 5);
  const auto in_parts = carried.painter->read_back().rgba;
  EXPECT_TRUE(carried.painter->undo()) << "the parts are one unit";
  EXPECT_EQ(carried.painter->coverage(), 0);
  ASSERT_TRUE(whole.context.make_current());
  whole.painter->upload(ramp.descriptor());
  whole.painter->paint(scenes::whole(whole.surface, {}), 1);
  EXPECT_EQ(whole.painter->read_back().rgba, in_parts);
  whole.painter.reset();
  ASSERT_TRUE(carried.context.make_current());
}

TEST(Painter, GivesBackTheBytesOfAUnitThatWentOnAfterARedo) {
  const ScopeModel scope = scenes::scope();
  Stage stage(scenes::plane(20, 40, 10), scope);
  const auto empty = stage.painter->read_back().rgba;
  const auto paint = [&](std::uint8_t level) {
    auto picture = scenes::flat(scope, level, level, level);
    stage.painter->upload(picture.descriptor());
    stage.painter->paint(scenes::whole(stage.surface, {}), 5);
  };
  paint(50);
  ASSERT_TRUE(stage.painter->undo());
  ASSERT_TRUE(stage.painter->redo());
  paint(200);
  ASSERT_TRUE(stage.painter->undo());
  EXPECT_EQ(stage.painter->read_back().rgba, empty);
  EXPECT_FALSE(stage.painter->undo());
}

TEST(Painter, ForgetsTheOldestUnitsWhenTheyAreMoreThanItKeeps) {
  const ScopeModel scope = scenes::scope();
  Stage stage(scenes::plane(20, 20, 4), scope, {.undo_units = 3});
  std::vector<std::uint8_t> after_the_second;
  for (std::uint32_t unit = 1; unit <= 5; ++unit) {
    auto picture = scenes::flat(scope, static_cast<std::uint8_t>(40 * unit), 0, 0);
    stage.painter->upload(picture.descriptor());
    stage.painter->paint(scenes::whole(stage.surface, {}), unit);
    if (unit == 2) after_the_second = stage.painter->read_back().rgba;
  }
  EXPECT_TRUE(stage.painter->undo() && stage.painter->undo() && stage.painter->undo());
  EXPECT_FALSE(stage.painter->undo());
  EXPECT_EQ(stage.painter->read_back().rgba, after_the_second);
}

TEST(Painter, SaysWhichPartOfTheSurfaceAViewTouched) {
  const ScopeModel scope = scenes::scope();
  Stage stage(scenes::plane(20, 40, 10), scope);
  auto picture = scenes::flat(scope, 1, 2, 3);
  stage.painter->upload(picture.descriptor());
  const std::uint64_t before = stage.painter->changes();
  CutoutPatch patch(1);
  patch.triangles = {0};
  stage.painter->paint(patch, 1);
  ASSERT_EQ(stage.painter->changes(), before + 1);
  const Eigen::AlignedBox3f box = stage.painter->touched_by(before + 1);
  EXPECT_EQ(box.min(), Eigen::Vector3f(-20, -20, 20));
  EXPECT_EQ(box.max(), Eigen::Vector3f(-16, -16, 20));
  stage.painter->undo();
  EXPECT_GT(stage.painter->touched_by(before + 2).diagonal().norm(), 1e6F);
}

TEST(Painter, EvensOutTheLightsFallWithDistance) {
  ScopeModel scope = scenes::scope();
  scope.fall_off = {.reference_mm = 20, .vignetting_cos_power = 0};
  Stage stage(scenes::plane(28.2843, 12, 4), scope, {.light = LightModel::fixed_exposure});  // half the light
  auto picture = scenes::flat(scope, 100, 100, 100);
  stage.painter->upload(picture.descriptor());
  stage.painter->paint(scenes::whole(stage.surface, {}), 1);
  const std::size_t painted =
      stage.for_each_texel([](std::size_t, const Eigen::Vector3d& p, const std::uint8_t* rgba) {
        const double cosine = p.z() / p.norm(), light = std::pow(20 / p.norm(), 2) * (cosine + 0.2) / 1.2;
        EXPECT_NEAR(rgba[0], 100 / std::pow(light, 1 / 2.2), 1.5);
      });
  EXPECT_GT(painted, 2'000u);
}

}  // namespace
}  // namespace orcart
