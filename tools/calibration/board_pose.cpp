// The corners' directions, flattened, go to a perspective-n-point solver.
#include "tools/calibration/board_pose.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

namespace orcart {

Result<Pose<C, B>> board_pose(const BoardView& view, const Lens& lens) {
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> flat;
  for (const BoardCorner& c : view.corners) {
    const auto direction = direction_of(lens, c.pixel_px);
    if (!direction || direction->z() < 0.05) continue;
    board.emplace_back(c.board_mm.x(), c.board_mm.y(), 0);
    flat.emplace_back(direction->x() / direction->z(), direction->y() / direction->z());
  }
  cv::Vec3d r, t;
  if (board.size() < 6 || !cv::solvePnP(board, flat, cv::Matx33d::eye(), cv::noArray(), r, t))
    return fail(view.image.string() + ": the board's pose cannot be told through this lens");
  const Eigen::Vector3d turn(r[0], r[1], r[2]);
  return Pose<C, B>{.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix(),
                    .translation_mm = {t[0], t[1], t[2]}};
}

std::vector<int> turns_alike(Anchor anchor) {
  if (anchor == Anchor::half_turn) return {0, 2};
  if (anchor == Anchor::quarter_turn) return {0, 1, 2, 3};
  return {0};
}

Pose<B, B> turned_about_middle(const Pattern& pattern, int quarter_turns) {
  const Eigen::Vector3d middle =
      0.5 * pattern.place_mm({pattern.corner_columns() - 1, pattern.corner_rows() - 1});
  Pose<B, B> turn;
  turn.rotation =
      Eigen::AngleAxisd(0.5 * std::numbers::pi * quarter_turns, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turn.translation_mm = middle - turn.rotation * middle;
  return turn;
}

void keep_one_numbering(std::vector<BoardView>& views) {
  if (std::ranges::none_of(views, &BoardView::coloured)) return;
  for (BoardView& view : views) {
    if (view.coloured || view.corners.empty() || view.anchor == Anchor::none) continue;
    view.anchor = Anchor::none;
    view.remark = "no coloured dots, which other pictures have";
  }
}

}  // namespace orcart
