// Where a pointer's tip lies in its marker, from poses taken while it turns about a fixed point.
#pragma once

#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "tools/registration/poses_file.hpp"

namespace orcart {

/// The algebraic solution for one set of poses: R_i tip + t_i = pivot.
struct PivotSolution {
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();    ///< in the marker
  Eigen::Vector3d pivot_mm = Eigen::Vector3d::Zero();  ///< in the tracker
  double rms_mm = 0;                                   ///< of the distances in space
  double rms_component_mm = 0;                         ///< of the single coordinates
  double worst_mm = 0;
  std::size_t poses = 0;
  Eigen::Vector3d deviation_mm = Eigen::Vector3d::Zero();  ///< standard deviations of the tip's coordinates
};

struct PivotFit {
  PivotSolution all;     ///< least squares over every pose
  PivotSolution robust;  ///< over those that agree
  double sweep_rad = 0;  ///< the widest angle between two poses
  double inlier_mm = 0;  ///< poses farther off than this were left out
};

/// Refuses sweeps that leave the tip open, and says why: too few poses, hardly any turn, turns about one axis
/// only.
Result<PivotFit> fit_pivot(const std::vector<NamedPose>& poses);

/// Each pose's distance from the pivot, and where the tool pointed. `text` is the answer as the terminal
/// shows it.
std::string pivot_page(const std::vector<NamedPose>& poses, const PivotFit& fit, const std::string& text);

}  // namespace orcart
