// The step across joins: of two exposures, of two distances, and what evening out leaves of it.
#include "tools/evaluate/recorded/light_steps.hpp"

#include <gtest/gtest.h>

#include "tests/tools/evaluate/recorded/drawn_board.hpp"

namespace orcart {
namespace {

using testing::DrawnBoard;

struct Seen {
  DrawnBoard board;
  double distance_mm = 28;
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
  double shift_mm = 0;  ///< along x
};

/// Both views together and alone.
LightStep step_between(const Seen& first, const Seen& second, LightModel light) {
  ScopeModel scope = testing::board_scope();
  scope.fall_off = {.reference_mm = 25, .vignetting_cos_power = 0};
  const PlaneExtent extent{.low_mm = {-6, -6}, .high_mm = {28, 24}};
  std::vector<PosedPicture> pictures;
  for (const Seen* seen : {&first, &second}) {
    Pose<M, C> X_MC = testing::camera_before(seen->board, seen->distance_mm, seen->tilt);
    X_MC.translation_mm.x() += seen->shift_mm;
    pictures.push_back({.picture = testing::drawn(seen->board, scope, X_MC), .X_MC = X_MC});
  }
  const OfflinePaintOptions options{.texel_mm = 0.1, .light = light};
  const FlatPainting together = *paint_plane(extent, scope, pictures, options);
  std::vector<FlatPainting> alone;
  for (PosedPicture& picture : pictures) {
    std::vector<PosedPicture> one{std::move(picture)};
    alone.push_back(*paint_plane(extent, scope, one, options));
  }
  return step_across("tested", joins_of(together), alone, 2.5);
}

TEST(LightSteps, AreNothingBetweenLikeViews) {
  const LightStep step = step_between({.shift_mm = -4}, {.shift_mm = 4}, LightModel::as_seen);
  EXPECT_GT(step.grey.count, 10U);
  EXPECT_LT(step.grey.max, 2);
}

TEST(LightSteps, AreTheDifferenceOfTwoExposures) {
  const LightStep step =
      step_between({.shift_mm = -4}, {.board = {.gain = 0.6}, .shift_mm = 4}, LightModel::as_seen);
  const double expected = 255 * (std::pow(0.7, 1 / 2.2) - std::pow(0.6 * 0.7, 1 / 2.2));
  EXPECT_NEAR(step.grey.mean, expected, 1.5);
  EXPECT_NEAR(step.percent, 100 * (1 - std::pow(0.6, 1 / 2.2)), 1);
}

TEST(LightSteps, AreEvenedOutWhereLightFallsWithDistance) {
  const Seen near{.board = {.lit_from_mm = 24}, .distance_mm = 24, .shift_mm = -3},
      far{.board = {.lit_from_mm = 24}, .distance_mm = 34, .shift_mm = 5};
  const LightStep before = step_between(far, near, LightModel::as_seen),
                  after = step_between(far, near, LightModel::fixed_exposure);
  EXPECT_GT(before.grey.mean, 30);
  EXPECT_LT(after.grey.mean, 0.25 * before.grey.mean);
}

}  // namespace
}  // namespace orcart
