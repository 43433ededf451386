// Corners in a painting, against boards drawn through a known lens: right poses, and poses that are known to
// be wrong.
#include "tools/evaluate/recorded/board_mapping.hpp"

#include <gtest/gtest.h>

#include "tests/tools/evaluate/recorded/drawn_board.hpp"

namespace orcart {
namespace {

using testing::DrawnBoard;

class BoardMapping : public ::testing::Test {
 protected:
  /// The picture from the true pose, painted from one that is off by `wrong_mm` along the board.
  ViewMapping mapped(const Eigen::Vector3d& wrong_mm) {
    const Pose<M, C> truth = testing::camera_before(board_, 28, {0.25, -0.2});
    const BoardView view = testing::true_view(board_, scope_, truth);
    Pose<M, C> believed = truth;
    believed.translation_mm += wrong_mm;
    std::vector<PosedPicture> pictures{{.picture = testing::drawn(board_, scope_, truth), .X_MC = believed}};
    auto flat = paint_plane(extent_of({view}, 5), scope_, pictures, {.texel_mm = 0.05});
    EXPECT_TRUE(flat) << flat.error().message;
    return corners_in_painting(view, parse_pattern("chessboard:12x10:2mm").value(), scope_.lens, believed,
                               *std::move(flat));
  }

  DrawnBoard board_;
  ScopeModel scope_ = testing::board_scope();
};

TEST_F(BoardMapping, FindsCornersWhereTheyArePrintedIfThePoseIsRight) {
  const ViewMapping mapping = mapped(Eigen::Vector3d::Zero());
  EXPECT_GE(mapping.seen, 90U);
  EXPECT_GE(mapping.corners.size(), mapping.seen * 9 / 10);
  EXPECT_LT(mapping.error.mean, 0.01);
  EXPECT_LT(mapping.error.max, 0.04);
}

TEST_F(BoardMapping, TellsAWrongPoseByTheMillimetresItIsOff) {
  const ViewMapping mapping = mapped({0.6, -0.3, 0});
  EXPECT_GE(mapping.corners.size(), mapping.seen * 9 / 10);
  EXPECT_NEAR(mapping.error.mean, std::hypot(0.6, 0.3), 0.005);
  EXPECT_LT(mapping.painting.mean, 0.01) << "painting itself is right";
  const PaintedCorner& corner = mapping.corners.front();
  EXPECT_LT((corner.found_mm - corner.grid_mm - Eigen::Vector2d(0.6, -0.3)).norm(), 0.04);
}

TEST_F(BoardMapping, DoesNotTakeTheNextCornerForTheRightOne) {
  // 1.8 mm of 2: the next corner printed is 0.2 mm away.
  EXPECT_NEAR(mapped({1.8, 0, 0}).error.mean, 1.8, 0.01);
}

TEST_F(BoardMapping, FindsNothingInAPaintingOfNothing) {
  const BoardView view = testing::true_view(board_, scope_, testing::camera_before(board_, 28, {0, 0}));
  FlatPainting flat{.extent = extent_of({view}, 5)};
  flat.bgr = cv::Mat::zeros(300, 300, CV_8UC3);
  const ViewMapping mapping =
      corners_in_painting(view, parse_pattern("chessboard:12x10:2mm").value(), scope_.lens,
                          testing::camera_before(board_, 28, {0, 0}), std::move(flat));
  EXPECT_TRUE(mapping.corners.empty());
  EXPECT_EQ(mapping.error.count, 0U);
}

TEST(BoardMappingCommand, RefusesWhatIsNotThere) {
  const auto report = evaluate_board({.hand_eye = {.images = {"/nowhere/a.png"},
                                                   .poses = "/nowhere/poses.csv",
                                                   .pattern = parse_pattern("chessboard:9x6:2mm").value()},
                                      .scope = "/nowhere/scope.toml"},
                                     [](const std::string&, double) {});
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("/nowhere/scope.toml"), std::string::npos) << report.error().message;
}

}  // namespace
}  // namespace orcart
