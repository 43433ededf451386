// Two tips that are known to be apart, and what a picture's noise makes of its own.
#include "tools/evaluate/recorded/board_tip.hpp"

#include <gtest/gtest.h>

#include "tests/tools/evaluate/recorded/drawn_board.hpp"
#include "tools/calibration/board_pose.hpp"
#include "tools/evaluate/random_stream.hpp"

namespace orcart {
namespace {

class BoardTip : public ::testing::Test {
 protected:
  Pose<B, C> truth(const Eigen::Vector2d& tilt) const {
    const Pose<M, C> X_MC = testing::camera_before(board_, 28, tilt);
    return {.rotation = X_MC.rotation, .translation_mm = X_MC.translation_mm};
  }
  BoardView view(const Eigen::Vector2d& tilt) const {
    return testing::true_view(board_, scope_, testing::camera_before(board_, 28, tilt));
  }

  testing::DrawnBoard board_;
  ScopeModel scope_ = testing::board_scope();
};

TEST_F(BoardTip, OfATipThatIsTooFarByAMillimetreIsOneInThreeDimensionsAndLessInDistances) {
  Pose<B, C> believed = truth({0, 0});
  believed.translation_mm -= 1.0 * Eigen::Vector3d::UnitZ();  // away from the board, along the axis
  const auto errors = tip_errors({.believed = believed, .seen = truth({0, 0}).inverse(), .X_CE = {}},
                                 view({0, 0}), scope_.lens, 0.3);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_NEAR(errors->apart_mm, 1, 1e-9);
  EXPECT_NEAR(errors->along_mm, 1, 1e-9);
  const BoardView seen = view({0, 0});
  ASSERT_EQ(errors->distances_mm.size(), seen.corners.size());
  // The middle of the board lies on the axis, at 28 mm: a corner off the axis by r is at hypot(r, 28).
  for (std::size_t i = 0; i < seen.corners.size(); ++i) {
    const double r = (seen.corners[i].board_mm - Eigen::Vector3d(11, 9, 0)).norm();
    EXPECT_NEAR(errors->distances_mm[i], std::hypot(r, 29) - std::hypot(r, 28), 1e-9);
  }
}

TEST_F(BoardTip, IsOfTheWindowWhereThePassportHasOne) {
  // Turned about C, a window 10 mm before it is off by the chord.
  Pose<B, C> believed = truth({0.1, 0});
  believed.translation_mm = truth({0, 0}).translation_mm;
  Pose<C, E> X_CE;
  X_CE.translation_mm = {0, 0, 10};
  const auto errors = tip_errors({.believed = believed, .seen = truth({0, 0}).inverse(), .X_CE = X_CE},
                                 view({0, 0}), scope_.lens, 0.3);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_NEAR(errors->apart_mm, 2 * 10 * std::sin(0.05), 1e-9);
}

TEST_F(BoardTip, OfThePictureItselfScattersAsIsTold) {
  constexpr double kSigma_px = 0.4;
  constexpr int kDraws = 200;
  const BoardView exact = view({0.25, -0.2});
  const Pose<B, C> camera = truth({0.25, -0.2});
  const auto told =
      tip_errors({.believed = camera, .seen = camera.inverse(), .X_CE = {}}, exact, scope_.lens, kSigma_px);
  ASSERT_TRUE(told) << told.error().message;
  RandomStream random(1, 1);
  double square = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    BoardView noisy = exact;
    for (BoardCorner& corner : noisy.corners)
      corner.pixel_px += kSigma_px * Eigen::Vector2d(random.gaussian(), random.gaussian());
    const auto X_CB = board_pose(noisy, scope_.lens);
    ASSERT_TRUE(X_CB) << X_CB.error().message;
    square += (X_CB->inverse().translation_mm - camera.translation_mm).squaredNorm() / kDraws;
  }
  EXPECT_NEAR(std::sqrt(square) / told->picture_mm, 1, 0.15);
}

TEST_F(BoardTip, RefusesABoardSeenEdgeOn) {
  const auto errors = tip_errors({.believed = truth({0, 0}), .seen = truth({1.5, 0}).inverse(), .X_CE = {}},
                                 view({0, 0}), scope_.lens, 1);
  ASSERT_FALSE(errors);
  EXPECT_NE(errors.error().message.find("edge on"), std::string::npos);
}

}  // namespace
}  // namespace orcart
