// The window's place comes out of known distances; what cannot tell it is refused in words.
#include "tools/calibration/tip.hpp"

#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "tests/tools/calibration/simulated_board.hpp"

namespace orcart {
namespace {

std::vector<TipView> views(double window_mm, double scale, const std::vector<double>& errors_mm) {
  std::vector<TipView> made;
  for (std::size_t i = 0; i < errors_mm.size(); ++i) {
    const double known = 10 + 5 * static_cast<double>(i);
    made.push_back({.name = "view" + std::to_string(i),
                    .known_mm = known,
                    .camera_mm = scale * known + window_mm + errors_mm[i]});
  }
  return made;
}

std::string refusal(const std::vector<TipView>& made) {
  const auto fit = fit_tip(made);
  return fit ? "" : fit.error().message;
}

TEST(Tip, WindowAndErrorsFollowFromTheDistances) {
  const auto fit = fit_tip(views(1.5, 1, {0.2, -0.2, 0, 0.2, -0.2}));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->window_mm, 1.5, 1e-12);
  EXPECT_NEAR(fit->errors_mm[0], 0.25, 1e-12);  // 0.2 against the mean of the four others, -0.05
  EXPECT_NEAR(fit->mean_mm, 0.2, 1e-12);
  EXPECT_NEAR(fit->worst_mm, 0.25, 1e-12);
  EXPECT_NEAR(fit->deviation_mm, std::sqrt(0.16 / 4 / 5), 1e-12);
  EXPECT_TRUE(fit->notes.empty());
}

TEST(Tip, RefusesWhatCannotTellIt) {
  EXPECT_NE(refusal(views(1, 1, {0, 0})).find("too few views"), std::string::npos);
  EXPECT_NE(refusal(views(1, 1.5, {0, 0, 0, 0, 0})).find("1.500 times as fast"), std::string::npos);
  auto alike = views(1, 1, {0, 0, 0});
  for (TipView& view : alike) view.known_mm = 20;
  EXPECT_NE(refusal(alike).find("alike"), std::string::npos);
  auto metres = views(1, 1, {0, 0, 0});
  for (TipView& view : metres) view.known_mm *= 1e-3;
  EXPECT_NE(refusal(metres).find("metres"), std::string::npos);
  auto behind = views(1, 1, {0, 0, 0});
  behind[1].known_mm = -5;
  EXPECT_NE(refusal(behind).find("view1"), std::string::npos);
}

/// The share of `draws` in which 95 % of what is told holds the true window: distances are off by 0.15 mm
/// RMS, corners by 0.2 px, the lens by its covariance.
double share_held(std::size_t count, int draws, double lens_deviation_px, std::uint32_t seed) {
  constexpr double kWindow_mm = 1.5, kDistance_mm = 0.15;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  ScopeModel scope;
  scope.width_px = 640, scope.height_px = 480;
  const Lens truth = testing::test_lens(LensModel::brown);
  scope.lens_covariance = LensCovariance::Zero();
  // A focal length is uncertain in x and y alike, as one board's size makes it.
  scope.lens_covariance->topLeftCorner<2, 2>().setConstant(lens_deviation_px * lens_deviation_px);
  int held = 0;
  for (int draw = 0; draw < draws; ++draw) {
    LensStep off = LensStep::Zero();
    off.head<2>().setConstant(lens_deviation_px * normal(random));
    scope.lens = stepped(truth, off);
    std::vector<BoardView> boards;
    std::vector<double> distances_mm;
    for (std::size_t i = 0; i < count; ++i) {
      const double known_mm = 10 + 20 * static_cast<double>(i) / static_cast<double>(count - 1);
      const Pose<C, B> X_CB =
          testing::board_before(known_mm + kWindow_mm, {0.1 * normal(random), 0.1 * normal(random), 0});
      BoardView view{.image = "view", .width_px = 640, .height_px = 480};
      for (int k = 0; k < 35; ++k) {
        const int column = k % 7, row = k / 7;
        const Eigen::Vector3d place(7 + 2.0 * column, 5 + 2.0 * row, 0);
        const auto pixel = project(truth, (X_CB * Point<B>{place}).mm);
        view.corners.push_back({.lattice = {column, row},
                                .pixel_px = *pixel + 0.2 * Eigen::Vector2d(normal(random), normal(random)),
                                .board_mm = place});
      }
      boards.push_back(std::move(view));
      distances_mm.push_back(known_mm + kDistance_mm * normal(random));
    }
    const auto told = calibrate_tip(boards, distances_mm, scope);
    if (!told) {
      ADD_FAILURE() << told.error().message;
      return 0;
    }
    const double deviation_mm = std::sqrt((*told->scope.window_covariance)(2, 2));
    held += std::abs(told->scope.X_CE.translation_mm.z() - kWindow_mm) <= 1.96 * deviation_mm;
  }
  return static_cast<double>(held) / draws;
}

TEST(Tip, ItsCovarianceHoldsTheTruthAsOftenAsItSays) {
  for (const std::size_t count : {3UL, 5UL, 8UL}) {
    const double without_lens = share_held(count, 1000, 0, 5), with_lens = share_held(count, 400, 4, 6);
    RecordProperty("held_" + std::to_string(count), std::to_string(without_lens));
    RecordProperty("held_with_lens_" + std::to_string(count), std::to_string(with_lens));
    std::printf("  %zu views: %.3f; with an uncertain lens %.3f\n", count, without_lens, with_lens);
    EXPECT_NEAR(without_lens, 0.95, 0.02);  // 3 standard deviations of 1,000 draws
    EXPECT_NEAR(with_lens, 0.95, 0.035);
  }
}

/// Four views of a board whose distances were measured from a window 2 mm before the optical centre.
struct FourViews {
  FourViews() {
    scope.width_px = 640, scope.height_px = 480;
    scope.lens = testing::test_lens(LensModel::brown);
    std::vector<Pose<C, B>> poses;
    boards = testing::simulated_views(
        scope.lens, {.views = 4, .noise_px = 0.1, .tilt_rad = 0.1, .nearest_mm = 20, .farthest_mm = 40},
        &poses);
    for (const auto& X_CB : poses) distances_mm.push_back(*axis_distance_mm(X_CB) - 2);
  }
  auto calibrated() const { return calibrate_tip(boards, distances_mm, scope); }

  ScopeModel scope;
  std::vector<BoardView> boards;
  std::vector<double> distances_mm;
};

TEST(Tip, NotesALensOfWhichNobodySaysHowWellItIsKnown) {
  const FourViews views;
  const auto told = views.calibrated();
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_NEAR(told->scope.X_CE.translation_mm.z(), 2, 0.1);
  ASSERT_FALSE(told->fit.notes.empty());
  EXPECT_NE(told->fit.notes.back().find("how well its lens is known"), std::string::npos);
  EXPECT_EQ(told->lens_mm, 0);
}

TEST(Tip, IsOnTheAxisByItsDefinitionAndSaysHowFarTheCirclesMiddleLiesBeside) {
  FourViews views;
  const auto without = views.calibrated();
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_FALSE(without->middle_mm) << "the passport has no circle";
  // A circle whose middle is seen atan(0.1) off the axis.
  const Eigen::Vector2d middle = project(views.scope.lens, {0.06, -0.08, 1}).value();
  views.scope.mask = {.cx_px = middle.x(), .cy_px = middle.y(), .radius_px = 200};
  const auto told = views.calibrated();
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_NEAR(told->middle_mm.value(), 0.1 * told->scope.X_CE.translation_mm.z(), 1e-6);
  EXPECT_TRUE(told->scope.X_CE.translation_mm.head<2>().isZero(0));
  Eigen::Matrix3d across = *told->scope.window_covariance;
  EXPECT_GT(across(2, 2), 0);
  across(2, 2) = 0;
  EXPECT_TRUE(across.isZero(0));
}

TEST(Tip, TheAxisMeetsATiltedBoardWhereItIs) {
  const Pose<C, B> X_CB =
      testing::board_before(30, {0.4, -0.3, 0.2});  // its middle lies on the axis at 30 mm
  const auto distance = axis_distance_mm(X_CB);
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 30, 1e-9);
  EXPECT_FALSE(axis_distance_mm(testing::board_before(30, {1.5, 0, 0})));
}

}  // namespace
}  // namespace orcart
