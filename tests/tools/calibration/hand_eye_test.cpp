// Hand-eye calibration in a simulated room: exact without noise, degenerate motions refused, half turns
// settled.
#include "tools/calibration/hand_eye.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/calibration/drawn_board.hpp"
#include "tests/tools/calibration/simulated_board.hpp"
#include "tools/calibration/board_pose.hpp"
#include "tools/calibration/hand_eye_command.hpp"
#include "tools/calibration/image_motion.hpp"
#include "tools/registration/json_text.hpp"

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

TEST(HandEye, ANameThatIsMissingIsRefusedAndToldRatherThanPairedByOrder) {
  PosesFile poses;
  for (const char* name : {"c", "a", "bb"}) poses.poses.push_back({.name = name, .X_TS = {}});
  const auto paired = poses_of_pictures({"a.png", "b.png", "c.png"}, poses, "poses.csv");
  ASSERT_FALSE(paired);
  EXPECT_NE(paired.error().message.find("no pose named b.png"), std::string::npos);
  for (NamedPose& pose : poses.poses) pose.name = "pose " + pose.name;
  EXPECT_TRUE(poses_of_pictures({"a.png", "b.png", "c.png"}, poses, "poses.csv")) << "none alike: by order";
  poses.poses[0] = {.name = "1", .X_TS = {}, .numbered = true};
  poses.poses[1] = {.name = "2", .X_TS = {}, .numbered = true};
  poses.poses[2] = {.name = "3", .X_TS = {}, .numbered = true};
  EXPECT_TRUE(poses_of_pictures({"0.png", "1.png", "2.png"}, poses, "poses.csv")) << "numbers are no names";
}

TEST(HandEye, TheSensorsDepthAndPosesInTheReferenceDoNotGoTogether) {
  HandEyeCommand command{.images = {}, .poses = "poses.csv", .pattern = {}, .noise = {.depth_ratio = 3}};
  command.noise.poses_in = PosesIn::reference;
  const auto refused = calibrate_hand_eye(command, {}, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--depth-ratio"), std::string::npos);
}

TEST(HandEye, ThreeViewsDoNotTellWhatLeavingOneOutWouldMake) {
  const TemporaryFolder folder;
  ScopeModel scope = testing::drawn_scope(test_lens(LensModel::brown), 320);
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.5);
  const testing::DrawnBoard board(scope, {});
  HandEyeCommand command{.images = {}, .poses = folder / "poses.csv", .pattern = {}, .noise = {}};
  command.pattern = parse_pattern("chessboard:9x8:3mm").value();
  std::string rows;
  const std::vector<Eigen::Vector3d> turns{{0.3, 0, 0}, {-0.2, 0.3, 0.2}, {0.1, -0.3, -0.3}};
  for (std::size_t v = 0; v < turns.size(); ++v) {
    const Pose<C, B> X_CB = testing::board_before(45, turns[v]);
    const Pose<T, S> X_TS = kX_TB * X_CB.inverse() * kX_SC.inverse();
    command.images.push_back(folder / json::format("view%zu.png", v));
    cv::imwrite(command.images.back().string(), board.seen_from(X_CB, static_cast<unsigned>(v)));
    rows += json::format("view%zu.png", v);
    for (int i = 0; i < 3; ++i)
      rows += json::format(",%.9g,%.9g,%.9g,%.6f", X_TS.rotation(i, 0), X_TS.rotation(i, 1),
                           X_TS.rotation(i, 2), X_TS.translation_mm[i]);
    rows += "\n";
  }
  folder.write("poses.csv", rows);
  const auto found = calibrate_hand_eye(command, scope, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->views.size(), 3U);
  EXPECT_FALSE(found->leave_one_out_mm);
  EXPECT_EQ(found->scope.residual_mm, found->refined.scatter_mm);
}

/// As a board is seen that looks the same after so many quarter turns.
void renumber(HandEyeView& view, const Pattern& pattern, int turns) {
  const Pose<B, B> turn = turned_about_middle(pattern, turns);
  view.X_CB = view.X_CB * turn;
  for (BoardCorner& c : view.board.corners) c.board_mm = (turn.inverse() * Point<B>{c.board_mm}).mm;
}

TEST(HandEye, SettlesBoardsThatLookTheSameUpsideDown) {
  const Pattern pattern = parse_pattern("chessboard:14x10:2mm").value();
  auto views = room(0);
  for (const std::size_t v : {2U, 5U}) renumber(views[v], pattern, 2);
  for (HandEyeView& view : views) view.board.anchor = Anchor::half_turn;
  settle_turns(views, pattern);
  const auto fit = hand_eye_closed_form(views);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->scatter_mm, 1e-6);
}

TEST(HandEye, SettlesBoardsThatLookTheSameOnTheirSides) {
  const Pattern pattern = parse_pattern("dots:7x7:2mm").value();
  auto views = room(0);
  for (std::size_t v = 0; v < views.size(); ++v) renumber(views[v], pattern, static_cast<int>(v) % 4);
  for (HandEyeView& view : views) view.board.anchor = Anchor::quarter_turn;
  const auto seen = views[3].board.corners.front();
  const Eigen::Vector3d before = (views[3].X_CB * Point<B>{seen.board_mm}).mm;
  settle_turns(views, pattern);
  const auto fit = hand_eye_closed_form(views);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->scatter_mm, 1e-6);
  const BoardCorner& after = views[3].board.corners.front();
  EXPECT_LT(((views[3].X_CB * Point<B>{after.board_mm}).mm - before).norm(), 1e-9);
  EXPECT_LT((pattern.place_mm(after.lattice) - after.board_mm).norm(), 1e-9);
}

TEST(HandEye, ViewsWithoutTheColouredDotsOfOthersAreNumberedOtherwise) {
  auto views = simulated_views(test_lens(LensModel::brown), {.views = 3});
  keep_one_numbering(views);
  EXPECT_EQ(views[0].anchor, Anchor::sure);
  views[1].coloured = true;
  keep_one_numbering(views);
  EXPECT_EQ(views[0].anchor, Anchor::none);
  EXPECT_EQ(views[1].anchor, Anchor::sure);
}

TEST(ImageMotion, SettlesBoardsThatLookTheSameOnTheirSides) {
  const Pattern pattern = parse_pattern("dots:7x7:2mm").value();
  std::vector<std::optional<SeenBoard>> seen;
  for (int i = 0; i < 8; ++i) {
    const Pose<B, B> back = turned_about_middle(pattern, i).inverse();
    const Point<B> marker{{40 + 0.5 * i, 10, 300}}, camera{{30 + 0.5 * i, 12, 40}};
    seen.push_back(SeenBoard{
        .sight = {.at_s = 0.1 * i, .marker_mm = (back * marker).mm, .camera_mm = (back * camera).mm},
        .anchor = Anchor::quarter_turn});
  }
  const auto sights = settled(seen, pattern);
  ASSERT_EQ(sights.size(), 8U);
  EXPECT_LT((sights[7].marker_mm - Eigen::Vector3d(43.5, 10, 300)).norm(), 1e-9);
  EXPECT_LT((sights[7].camera_mm - Eigen::Vector3d(33.5, 12, 40)).norm(), 1e-9);
  seen[4]->coloured = true;
  EXPECT_EQ(settled(seen, pattern).size(), 1U);
}

}  // namespace
}  // namespace orcart
