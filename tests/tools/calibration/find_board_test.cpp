// Boards drawn through a homography and found again: whole, in part, blurred, as ChArUco in both layouts, as
// dots.
#include "tools/calibration/board_view.hpp"

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

namespace orcart {
namespace {

/// From board units of 40 px to the picture: a view from the side.
const cv::Matx33d kView(0.82, 0.12, 60, -0.10, 0.80, 90, 1e-4, -1.2e-4, 1);

cv::Mat seen(const cv::Mat& board, double blur_px) {
  cv::Mat picture;
  cv::warpPerspective(board, picture, kView, {800, 600}, cv::INTER_AREA, cv::BORDER_CONSTANT,
                      cv::Scalar::all(225));
  cv::GaussianBlur(picture, picture, {}, blur_px);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

/// (columns + 1) x (rows + 1) squares of 40 px with a white margin of 40 px; inner corner (0, 0) lies at
/// (79.5, 79.5).
cv::Mat chessboard(int columns, int rows) {
  cv::Mat board(40 * (rows + 3), 40 * (columns + 3), CV_8U, cv::Scalar(225));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      if ((i + j) % 2 == 0) board(cv::Rect(40 + 40 * i, 40 + 40 * j, 40, 40)).setTo(30);
  return board;
}

Eigen::Vector2d truth(double x, double y) {
  const cv::Vec3d p = kView * cv::Vec3d(x, y, 1);
  return {p[0] / p[2], p[1] / p[2]};
}

double worst_px(const BoardView& view, double origin, double step) {
  double worst = 0;
  for (const BoardCorner& c : view.corners)
    worst = std::max(
        worst, (c.pixel_px - truth(origin + step * c.lattice.x(), origin + step * c.lattice.y())).norm());
  return worst;
}

TEST(FindBoard, FindsAWholeChessboardToATenthOfAPixel) {
  for (const double blur : {0.7, 2.0}) {
    const BoardView view =
        find_board(seen(chessboard(11, 8), blur), parse_pattern("chessboard:11x8:3mm").value());
    ASSERT_EQ(view.corners.size(), 88U) << view.remark;
    EXPECT_EQ(view.anchor, Anchor::sure);
    EXPECT_LT(worst_px(view, 79.5, 40), 0.15);
    EXPECT_EQ(view.corners[1].board_mm, Eigen::Vector3d(0, 3, 0));
  }
}

TEST(FindBoard, SaysWhenTheBoardIsLargerThanStated) {
  const BoardView view = find_board(seen(chessboard(11, 8), 1), parse_pattern("chessboard:9x6:3mm").value());
  EXPECT_TRUE(view.corners.empty());
  EXPECT_NE(view.remark.find("11x8"), std::string::npos);
}

TEST(FindBoard, UsesAPartOfABoard) {
  cv::Mat picture = seen(chessboard(11, 8), 1);
  picture(cv::Rect(0, 0, 260, 600)).setTo(cv::Scalar::all(0));
  const BoardView view = find_board(picture, parse_pattern("chessboard:11x8:3mm").value());
  EXPECT_GT(view.corners.size(), 40U);
  EXPECT_EQ(view.anchor, Anchor::none);
}

TEST(FindBoard, FindsNothingInAnEmptyPicture) {
  const BoardView view = find_board(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(90)),
                                    parse_pattern("chessboard:11x8:3mm").value());
  EXPECT_TRUE(view.corners.empty());
  EXPECT_FALSE(view.remark.empty());
}

/// A ChArUco board of 40 px squares and 30 px markers, margin 40 px.
cv::Mat charuco(int columns, int rows, bool legacy) {
  cv::Mat board(40 * (rows + 2), 40 * (columns + 2), CV_8U, cv::Scalar(225)), marker;
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_250);
  int id = 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const bool dark = ((i + j) % 2 == 0) != (legacy && rows % 2 == 0);
      if (dark) {
        board(cv::Rect(40 + 40 * i, 40 + 40 * j, 40, 40)).setTo(20);
      } else {
        cv::aruco::drawMarker(dictionary, id++, 30, marker);
        marker.copyTo(board(cv::Rect(45 + 40 * i, 45 + 40 * j, 30, 30)));
      }
    }
  return board;
}

TEST(FindBoard, FindsBothLayoutsOfACharucoBoard) {
  for (const bool legacy : {false, true})
    for (const char* text : {"charuco:12x8:4mm:3mm:4X4_250", "charuco:12x8:4mm:3mm:4X4_250:legacy"}) {
      const BoardView view = find_board(seen(charuco(12, 8, legacy), 0.7), parse_pattern(text).value());
      ASSERT_GT(view.corners.size(), 60U) << text << legacy << view.remark;
      EXPECT_EQ(view.anchor, Anchor::sure);
      EXPECT_LT(worst_px(view, 79.5, 40), 0.5) << text << legacy;
    }
}

TEST(FindBoard, FindsAGridOfDots) {
  cv::Mat board(440, 560, CV_8U, cv::Scalar(225));
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 12; ++i)
      cv::circle(board, {60 + 40 * i, 60 + 40 * j}, 10, cv::Scalar(30), cv::FILLED, cv::LINE_AA);
  const BoardView view = find_board(seen(board, 1), parse_pattern("dots:12x9:4mm").value());
  ASSERT_EQ(view.corners.size(), 108U) << view.remark;
  EXPECT_LT(worst_px(view, 60, 40), 0.4);
}

TEST(FindBoard, TellsWhichBoardsLookTheSameOnTheirSides) {
  const auto anchor = [](const cv::Mat& board, const char* pattern) {
    const BoardView view = find_board(seen(board, 1), parse_pattern(pattern).value());
    EXPECT_FALSE(view.corners.empty()) << pattern << view.remark;
    return view.anchor;
  };
  EXPECT_EQ(anchor(chessboard(8, 8), "chessboard:8x8:3mm"), Anchor::quarter_turn);
  EXPECT_EQ(anchor(chessboard(9, 9), "chessboard:9x9:3mm"), Anchor::half_turn);
  cv::Mat dots(440, 440, CV_8U, cv::Scalar(225));
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i)
      cv::circle(dots, {60 + 40 * i, 60 + 40 * j}, 10, cv::Scalar(30), cv::FILLED, cv::LINE_AA);
  EXPECT_EQ(anchor(dots, "dots:9x9:4mm"), Anchor::quarter_turn);
}

}  // namespace
}  // namespace orcart
