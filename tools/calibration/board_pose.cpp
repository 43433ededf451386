// The corners' directions, flattened, go to a perspective-n-point solver.
#include "tools/calibration/board_pose.hpp"

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

}  // namespace orcart
