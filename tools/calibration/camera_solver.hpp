// Intrinsics and board poses that best explain the corners seen: Zhang 2000, refined by Levenberg and
// Marquardt.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/pose.hpp"
#include "realtime/optics/lens_covariance.hpp"
#include "tools/calibration/board_view.hpp"
#include "tools/calibration/lens_cost.hpp"

namespace orcart {

struct B {};  ///< the calibration board: x along columns, y along rows, z away from the camera

struct ViewFit {
  Pose<C, B> X_CB;
  double rms_px = 0, worst_px = 0;
  double rms_mm = 0;        ///< the same on the board's plane
  double distance_mm = 0;   ///< from the optical centre to the middle of what is seen
  double tilt_rad = 0;      ///< between the board's normal and the optical axis
  std::size_t dropped = 0;  ///< corners left out because they lay too far off
};

struct CameraFit {
  Lens lens;                   ///< max_angle_rad is set
  std::vector<ViewFit> views;  ///< in the order of the views given
  double rms_px = 0, rms_mm = 0;
  std::array<double, kIntrinsics>
      deviations{};        ///< standard deviations of the intrinsics; 0 where held. See lens_cost.hpp
  bool determined = true;  ///< false where the equations leave something open
  std::optional<LensCovariance> covariance;  ///< scaled by the residuals; nothing where not determined
  std::size_t corners = 0;
};

struct CameraTask {
  LensModel model = LensModel::brown;
  int coefficients = 5;  ///< brown: 5, 4 (no k3), 2 (k1 k2), 1; fisheye: 4, 2; poly4: 3
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< where to look for the principal point first
  std::vector<double> distances_mm;  ///< empty: free poses; else one a view, known but for a common offset
};

/// Views without corners are refused by the caller. Fails where no start leads anywhere.
Result<CameraFit> solve_camera(std::vector<BoardView>& views, const CameraTask& task);

/// Root mean square distance of the corners on the board's plane, mm.
double rms_on_board_mm(const Lens& lens, const Pose<C, B>& X_CB, const std::vector<BoardCorner>& corners);

}  // namespace orcart
