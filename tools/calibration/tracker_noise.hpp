// How far a tracked marker body may be off, from the noise of its single markers.
#pragma once

#include <Eigen/Core>

namespace orcart {

/// What the marker's poses were told in.
enum class PosesIn {
  tracker,    ///< the position sensor: only the scope's body is noisy, most along the sensor's z
  reference,  ///< a reference body beside the board: both are noisy, and its turns swing the scope about it
};

struct TrackerNoise {
  double marker_mm = 0.25;     ///< RMS of one marker's 3-D error, as trackers state it
  double body_radius_mm = 30;  ///< RMS distance of the four markers from their middle
  double depth_ratio = 1;  ///< along the sensor's z against x and y; 3 for a Polaris. In the reference: none
  PosesIn poses_in = PosesIn::tracker;
};

/// Turn (rad) and shift (mm) of a body whose pose was fitted to four noisy markers, about its own origin, in
/// the axes the pose is told in; `place_mm` is where the body is there. Averaged over how the markers may
/// lie: with N markers of mean square radius r2 the turn's covariance is 3 (trace(S) I - S) / (4 N r2), S one
/// marker's (first order). A flat body turns up to a quarter more.
Eigen::Matrix<double, 6, 6> pose_covariance(const TrackerNoise& noise, const Eigen::Vector3d& place_mm);

}  // namespace orcart
