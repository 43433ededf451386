// Hand-eye calibration in a simulated room: exact without noise, degenerate motions refused, half turns
// settled.
#include "tools/calibration/hand_eye.hpp"

#include <gtest/gtest.h>

#include "tests/tools/calibration/simulated_board.hpp"

namespace orcart {
namespace {

using testing::simulated_views;
using testing::test_lens;

const Pose<S, C> kX_SC{
    .rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
    .translation_mm = {-15, 190, -60}};
const Pose<T, B> kX_TB{
    .rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d(0, 1, 1).normalized()).toRotationMatrix(),
    .translation_mm = {50, -120, -1400}};

std::vector<HandEyeView> room(double noise_px) {
  std::vector<Pose<C, B>> poses;
  const auto boards = simulated_views(test_lens(LensModel::brown), {.noise_px = noise_px}, &poses);
  std::vector<HandEyeView> views;
  for (std::size_t v = 0; v < boards.size(); ++v)
    views.push_back(
        {.X_TS = kX_TB * poses[v].inverse() * kX_SC.inverse(), .X_CB = poses[v], .board = boards[v]});
  return views;
}

TEST(HandEye, ClosedFormIsExactWithoutNoise) {
  const auto fit = hand_eye_closed_form(room(0));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_TRUE(fit->X_SC.rotation.isApprox(kX_SC.rotation, 1e-9));
  EXPECT_LT((fit->X_SC.translation_mm - kX_SC.translation_mm).norm(), 1e-6);
  EXPECT_LT(fit->scatter_mm, 1e-6);
}

TEST(HandEye, TheLeastLeftOutIsNothingForPosesThatFitAndIsMadeByOneThatDoesNot) {
  auto views = room(0);
  const Twist aside = (Twist() << 2, -1, 3, 0.02, -0.01, 0.03).finished();
  EXPECT_LT(least_left_out_mm(views, moved(kX_SC, aside)), 1e-6) << "from a start beside the truth";
  views[1].X_TS.translation_mm.x() += 3;
  const double least = least_left_out_mm(views, kX_SC);
  std::vector<double> each;
  const auto n = static_cast<double>(views.size());
  EXPECT_LE(least, scatter_mm(views, kX_SC, each) * n / (n - 1) + 1e-9);
  EXPECT_GT(least, 0.3) << "no turn or shift of the camera moves one view alone";
}

TEST(HandEye, RefinementKeepsTheTruthAndHeldLens) {
  const Lens lens = test_lens(LensModel::brown);
  const auto fit = refine_hand_eye(room(0.2), lens, {});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->X_SC.translation_mm - kX_SC.translation_mm).norm(), 0.3);
  EXPECT_NEAR(fit->lens.fx_px, lens.fx_px, 1);
  const auto held = refine_hand_eye(room(0.2), lens, {.role = LensRole::held});
  ASSERT_TRUE(held);
  EXPECT_EQ(held->lens.fx_px, lens.fx_px);
}

TEST(HandEye, RefusesMotionsThatLeaveItOpen) {
  auto views = room(0);
  EXPECT_NE(hand_eye_closed_form({views[0], views[1]}).error().message.find("too few views"),
            std::string::npos);
  for (HandEyeView& view : views) view = views[0];
  EXPECT_NE(hand_eye_closed_form(views).error().message.find("degrees"), std::string::npos);
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Pose<C, B> X_CB = testing::board_before(30, Eigen::Vector3d(0.1 * static_cast<double>(v), 0, 0));
    views[v].X_CB = X_CB;
    views[v].X_TS = kX_TB * X_CB.inverse() * kX_SC.inverse();
  }
  EXPECT_NE(hand_eye_closed_form(views).error().message.find("one axis only"), std::string::npos);
}

TEST(HandEye, SettlesBoardsThatLookTheSameUpsideDown) {
  const Pattern pattern = parse_pattern("chessboard:14x10:2mm").value();
  auto views = room(0);
  Pose<B, B> half;
  half.rotation = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  half.translation_mm = pattern.place_mm({13, 9});
  for (const std::size_t v : {2U, 5U}) {
    views[v].X_CB = views[v].X_CB * half;
    for (BoardCorner& c : views[v].board.corners) c.board_mm = pattern.place_mm({13, 9}) - c.board_mm;
  }
  for (HandEyeView& view : views) view.board.anchor = Anchor::half_turn;
  settle_half_turns(views, pattern);
  const auto fit = hand_eye_closed_form(views);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->scatter_mm, 1e-6);
}

}  // namespace
}  // namespace orcart
