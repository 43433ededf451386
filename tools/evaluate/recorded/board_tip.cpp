// Two tips, the board's points, and the covariance of the picture's own.
#include "tools/evaluate/recorded/board_tip.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "realtime/geometry/twist.hpp"
#include "tools/calibration/tip.hpp"

namespace orcart {
namespace {

/// First order at the picture's pose: of a twist in C. Corners beyond the lens say nothing.
TwistCovariance pose_covariance(const Pose<C, B>& X_CB, const BoardView& view, const Lens& lens,
                                double corner_sigma_px) {
  const Pose<B, C> X_BC = X_CB.inverse();
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  for (const BoardCorner& corner : view.corners) {
    Eigen::Matrix<double, 2, 6> slope;
    bool seen = true;
    for (int i = 0; i < 6; ++i) {
      const double step = i < 3 ? 1e-3 : 1e-5;  // mm, rad
      Twist twist = Twist::Zero();
      twist[i] = step;
      const auto pixel = [&](const Twist& by) {
        return project(lens, (moved(X_BC, by).inverse() * Point<B>{corner.board_mm}).mm);
      };
      const auto plus = pixel(twist), minus = pixel(-twist);
      seen = seen && plus && minus;
      if (seen) slope.col(i) = (*plus - *minus) / (2 * step);
    }
    if (seen) information += slope.transpose() * slope / (corner_sigma_px * corner_sigma_px);
  }
  return information.ldlt().solve(TwistCovariance::Identity());
}

}  // namespace

Result<TipErrors> tip_errors(const TipPlaces& places, const BoardView& view, const Lens& lens,
                             double corner_sigma_px) {
  const Eigen::Vector3d believed = (places.believed * places.X_CE).translation_mm,
                        seen = (places.seen.inverse() * places.X_CE).translation_mm;
  TipErrors errors{.apart_mm = (believed - seen).norm()};
  for (const BoardCorner& corner : view.corners)
    errors.distances_mm.push_back(
        std::abs((corner.board_mm - believed).norm() - (corner.board_mm - seen).norm()));
  const auto known = axis_distance_mm(places.seen), told = axis_distance_mm(places.believed.inverse());
  if (!known) return tl::unexpected(known.error());
  if (!told) return tl::unexpected(told.error());
  errors.along_mm = *told - *known;
  const TwistCovariance open =
      covariance_seen_from(places.X_CE, pose_covariance(places.seen, view, lens, corner_sigma_px));
  errors.picture_mm = std::sqrt(open.topLeftCorner<3, 3>().trace());
  return errors;
}

}  // namespace orcart
