// How far painted light lies from where it came from, with exact poses and without noise.
#include <gtest/gtest.h>

#include "firmware-host/app/truth_check.hpp"
#include "tests/path/cart_rig.hpp"

namespace orcart::testing {
namespace {

PaintingError error_in(TextureMode mode) {
  RigWish wish = presses();
  wish.texel_mm = 0.15;
  const auto rig = CartRig::create(wish);
  if (!rig) return {};
  const SimulatedWorld& world = rig->devices->world();
  std::vector<JudgedView> views;
  for (const Nanos at : {1200ms, 2800ms, 4400ms}) {
    const Pose<M, C> X_MC = world.X_MC(rig->at(at));
    views.push_back({.believed = X_MC, .true_pose = X_MC});
  }
  const auto error = check_painting(rig->patient, views, {.seen_from = rig->config.seen_from, .mode = mode});
  if (!error) {
    ADD_FAILURE() << error.error().message;
    return {};
  }
  const char* name = mode == TextureMode::paper ? "paper" : "perspective";
  ::testing::Test::RecordProperty(std::string(name) + "_mean_mm", std::to_string(error->mean_mm));
  ::testing::Test::RecordProperty(std::string(name) + "_max_mm", std::to_string(error->max_mm));
  return *error;
}

TEST(PaintingError, IsUnderATenthOfAMillimetreInPerspectiveModeAndPaperModeIsWorse) {
  const PaintingError perspective = error_in(TextureMode::perspective);
  EXPECT_GT(perspective.texels, 1000u);
  EXPECT_LE(perspective.mean_mm, 0.10);
  EXPECT_LE(perspective.max_mm, 0.30);
  const PaintingError paper = error_in(TextureMode::paper);
  EXPECT_GT(paper.texels, 1000u);
  EXPECT_GT(paper.mean_mm, perspective.mean_mm);
}

}  // namespace
}  // namespace orcart::testing
