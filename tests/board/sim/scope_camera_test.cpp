// The simulated scope: where a picture's light comes from, its circle, its light, its noise and its bytes.
#include "board/sim/scope_camera.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "board/sim/picture_png.hpp"
#include "board/sim/sensor.hpp"
#include "tests/board/sim/pattern_scope.hpp"
#include "tests/board/sim/test_shapes.hpp"

namespace orcart {
namespace {

/// Inside a ball of 20 mm.
class ScopeCameraTest : public ::testing::Test {
 protected:
  TriangleMesh mesh_ = testing::ellipsoid({20, 20, 20}, 60, 80);
  RayScene rays_ = *RayScene::create(mesh_);
  ScopeModel scope_ = testing::pattern_scope();
  Pose<M, C> X_MC_{
      .rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
      .translation_mm = {3, -2, 4}};

  std::vector<std::byte> draw(const SceneLook& look, PixelFormat format, const std::vector<Pose<M, C>>& poses,
                              std::uint64_t frame = 0) {
    const ScopeCamera camera(mesh_, rays_, scope_, look);
    ScopeCamera::Scratch scratch;
    std::vector<std::byte> bytes(packed_bytes(format, scope_.width_px, scope_.height_px));
    camera.draw({.frame = frame, .poses = poses, .gain = camera.fitting_gain(poses[0], scratch)}, scratch,
                packed_image(bytes.data(), format, scope_.width_px, scope_.height_px));
    return bytes;
  }
  std::vector<std::byte> draw(const SceneLook& look) { return draw(look, PixelFormat::yuyv, {X_MC_}); }
  double luma(const std::vector<std::byte>& yuyv, int x, int y) const {
    return std::to_integer<int>(yuyv[2 * static_cast<std::size_t>(y * scope_.width_px + x)]);
  }
};

constexpr float kCoarse_mm = 0.3F;  // quick to sample
const SceneLook kWhole{.texel_mm = kCoarse_mm};
const SceneLook kPlain{.lighting = Effect::off,
                       .specular = Effect::off,
                       .noise = Effect::off,
                       .blur = Effect::off,
                       .texel_mm = kCoarse_mm};
const SceneLook kFine{.lighting = Effect::off, .noise = Effect::off, .texel_mm = 0.08F};

TEST_F(ScopeCameraTest, ShowsAtEachPixelTheCodeOfThePointItsRayMeets) {
  for (int axis : {0, 1, 2}) {
    const CodedTissue code{.axis = axis, .period_mm = 30, .phase_rad = 0.3};
    const auto picture = draw({.tissue = code});
    for (const auto& [x, y] : {std::pair{80, 60}, {50, 40}, {110, 85}, {80, 20}, {33, 60}}) {
      const Eigen::Vector3d direction = X_MC_.rotation * *direction_of(scope_.lens, {x, y});
      const auto hit = rays_.nearest(X_MC_.translation_mm.cast<float>(), direction.cast<float>(), 100);
      ASSERT_TRUE(hit);
      const Eigen::Vector3f p = (X_MC_.translation_mm + hit->distance_mm * direction).cast<float>();
      EXPECT_NEAR(luma(picture, x, y), 16 + 219 * coded_grey(p, code), 0.7) << "axis " << axis << " at " << x;
    }
  }
}

TEST_F(ScopeCameraTest, IsBlackOutsideItsCircleAndNotInside) {
  const auto picture = draw(kWhole);
  EXPECT_LT(luma(picture, 2, 2), 25);
  EXPECT_LT(luma(picture, 80, 2), 25) << "above the circle, whose top is at row 6";
  EXPECT_GT(luma(picture, 80, 60), 60);
  EXPECT_GT(luma(picture, 80, 14), 40);
}

TEST_F(ScopeCameraTest, IsTheSameTwiceAndItsNoiseAnotherInEachFrame) {
  EXPECT_EQ(draw(kWhole), draw(kWhole));
  EXPECT_NE(draw(kWhole, PixelFormat::yuyv, {X_MC_}, 1), draw(kWhole, PixelFormat::yuyv, {X_MC_}, 2));
  EXPECT_EQ(draw(kPlain, PixelFormat::yuyv, {X_MC_}, 1), draw(kPlain, PixelFormat::yuyv, {X_MC_}, 2));
}

TEST_F(ScopeCameraTest, ShowsTheReflectanceItselfInEvenLight) {
  const auto picture = draw(kFine);
  const Eigen::Vector3d direction = X_MC_.rotation * *direction_of(scope_.lens, {80.0, 60.0});
  const auto hit = rays_.nearest(X_MC_.translation_mm.cast<float>(), direction.cast<float>(), 100);
  const Eigen::Vector3f truth =
      tissue_colour((X_MC_.translation_mm + hit->distance_mm * direction).cast<float>(), 1)
          .unaryExpr(&displayed);
  const double wanted = 16 + 65.481 * truth.x() + 128.553 * truth.y() + 24.966 * truth.z();
  EXPECT_NEAR(luma(picture, 80, 60), wanted, 4);
}

TEST_F(ScopeCameraTest, LightsNearWallsMoreThanFarOnes) {
  // From (0, 0, 8) the wall is 12 mm away along +z and 28 mm along -z.
  const SceneLook look{.specular = Effect::off, .texel_mm = kCoarse_mm};
  const ScopeCamera camera(mesh_, rays_, scope_, look);
  ScopeCamera::Scratch scratch;
  Pose<M, C> near{.rotation = Eigen::Matrix3d::Identity(), .translation_mm = {0, 0, 8}};
  Pose<M, C> far = near;
  far.rotation = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_GT(camera.fitting_gain(far, scratch), 3 * camera.fitting_gain(near, scratch));
}

TEST_F(ScopeCameraTest, BlursAcrossThePosesOfAnExposure) {
  const SceneLook look{.specular = Effect::off, .noise = Effect::off, .texel_mm = kCoarse_mm};
  Pose<M, C> moved = X_MC_;
  moved.rotation = X_MC_.rotation * Eigen::AngleAxisd(0.08, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const auto contrast = [&](const std::vector<std::byte>& picture) {
    double sum = 0;
    for (int y = 30; y < 90; ++y)
      for (int x = 50; x < 110; ++x) sum += std::abs(luma(picture, x + 1, y) - luma(picture, x, y));
    return sum;
  };
  const auto sharp = draw(look, PixelFormat::yuyv, {X_MC_});
  const auto blurred = draw(look, PixelFormat::yuyv, {X_MC_, interpolate(X_MC_, moved, 0.5), moved});
  EXPECT_LT(contrast(blurred), 0.85 * contrast(sharp));
}

TEST_F(ScopeCameraTest, ShowsTheSameInBothPixelFormats) {
  auto yuyv = draw(kPlain), nv12 = draw(kPlain, PixelFormat::nv12, {X_MC_});
  const auto a = rgb_of(packed_image(yuyv.data(), PixelFormat::yuyv, scope_.width_px, scope_.height_px));
  const auto b = rgb_of(packed_image(nv12.data(), PixelFormat::nv12, scope_.width_px, scope_.height_px));
  ASSERT_EQ(a.size(), b.size());
  double difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference += std::abs(a[i] - b[i]);
  EXPECT_LT(difference / static_cast<double>(a.size()), 1.5);
}

TEST(Sensor, KeepsTheSrgbCurveBelowTheShoulderAndNeverClipsHard) {
  EXPECT_NEAR(displayed(0), 0, 1e-4);
  EXPECT_NEAR(displayed(0.2140F), 0.5, 1e-3);
  EXPECT_LT(displayed(0.9F), displayed(1.2F));
  EXPECT_LE(displayed(50), 1.0F);
}

TEST(Sensor, AddsTheNoiseOfLight) {
  for (float level : {0.0F, 0.25F, 1.0F}) {
    std::vector<Eigen::Vector3f> light(20'000, Eigen::Vector3f::Constant(level));
    add_sensor_noise(light, 7);
    double sum = 0, squares = 0;
    for (const auto& value : light) {
      sum += value.x();
      squares += (value.x() - level) * (value.x() - level);
    }
    EXPECT_NEAR(sum / 20'000, level, 3e-4);
    EXPECT_NEAR(std::sqrt(squares / 20'000), std::sqrt(1e-4 * level + 2.25e-6), 2e-4);
  }
}

}  // namespace
}  // namespace orcart
