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
