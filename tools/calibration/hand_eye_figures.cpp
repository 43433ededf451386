// What the residuals and the declared noise say about a hand-eye calibration.
#include <cmath>

#include "tools/calibration/hand_eye.hpp"

namespace orcart {

double corners_alike(const std::vector<HandEyeView>& views, const Lens& lens) {
  constexpr double kNear_squares = 3;
  double together = 0, alone = 0;
  for (const HandEyeView& view : views) {
    std::vector<Eigen::Vector2d> off, at;
    for (const BoardCorner& c : view.board.corners)
      if (const auto seen = project(lens, (view.X_CB * Point<B>{c.board_mm}).mm)) {
        off.emplace_back(*seen - c.pixel_px);
        at.emplace_back(c.lattice.cast<double>());
      }
    for (std::size_t i = 0; i < off.size(); ++i) {
      alone += off[i].squaredNorm();
      for (std::size_t j = 0; j < off.size(); ++j)
        if ((at[i] - at[j]).squaredNorm() < kNear_squares * kNear_squares + 0.1)
          together += off[i].dot(off[j]);
    }
  }
  return alone > 0 ? std::max(1.0, together / alone) : 1;
}

double least_left_out_mm(const std::vector<HandEyeView>& views, const Pose<S, C>& start) {
  constexpr int kSteps = 20;  // Gauss-Newton on a problem that is linear but for a small turn
  const auto count = static_cast<Eigen::Index>(views.size());
  Pose<S, C> X_SC = start;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix3Xd origins(3, count);
    Eigen::MatrixXd moves(3 * count, 6);  // of each origin, by a twist of the camera: shift, turn
    Eigen::Matrix<double, 3, 6> mean_move = Eigen::Matrix<double, 3, 6>::Zero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const HandEyeView& view = views[static_cast<std::size_t>(i)];
      const Eigen::Vector3d& p = view.X_CB.translation_mm;
      origins.col(i) = (view.X_TS * X_SC * view.X_CB).translation_mm;
      Eigen::Matrix3d turned;
      turned << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
      moves.middleRows<3>(3 * i) << Eigen::Matrix3d::Identity(), turned;
      moves.middleRows<3>(3 * i) = (view.X_TS.rotation * X_SC.rotation * moves.middleRows<3>(3 * i)).eval();
      mean_move += moves.middleRows<3>(3 * i) / static_cast<double>(count);
    }
    const Eigen::Matrix3Xd apart = origins.colwise() - origins.rowwise().mean();
    for (Eigen::Index i = 0; i < count; ++i) moves.middleRows<3>(3 * i) -= mean_move;
    const Twist twist = -moves.completeOrthogonalDecomposition().solve(apart.reshaped());
    X_SC = moved(X_SC, twist);
  }
  std::vector<double> each;
  const double scatter = scatter_mm(views, X_SC, each);
  return scatter * static_cast<double>(count) / static_cast<double>(count - 1);
}

double tracker_floor_mm(const std::vector<HandEyeView>& views, const HandEyeFit& fit,
                        const TrackerNoise& noise) {
  double sum2 = 0;
  for (const HandEyeView& view : views) {
    const Eigen::Vector3d lever = fit.X_TB.translation_mm - view.X_TS.translation_mm;
    Eigen::Matrix<double, 3, 6> swing;
    swing << 0, lever.z(), -lever.y(), 1, 0, 0, -lever.z(), 0, lever.x(), 0, 1, 0, lever.y(), -lever.x(), 0,
        0, 0, 1;
    sum2 += (swing * pose_covariance(noise, view.X_TS.translation_mm) * swing.transpose()).trace();
  }
  return std::sqrt(sum2 / static_cast<double>(views.size()));
}

}  // namespace orcart
