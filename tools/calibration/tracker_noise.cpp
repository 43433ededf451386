// One body, or two of which the reference's turns swing the other about it.
#include "tools/calibration/tracker_noise.hpp"

#include "realtime/geometry/pose.hpp"

namespace orcart {
namespace {

constexpr double kMarkers = 4;

Eigen::Matrix<double, 6, 6> body_covariance(const Eigen::Vector3d& marker_mm2, double radius_mm) {
  const Eigen::Matrix3d marker = marker_mm2.asDiagonal();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance.topLeftCorner<3, 3>() =
      3 * (marker.trace() * Eigen::Matrix3d::Identity() - marker) / (4 * kMarkers * radius_mm * radius_mm);
  covariance.bottomRightCorner<3, 3>() = marker / kMarkers;
  return covariance;
}

Eigen::Matrix3d crossed(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Eigen::Matrix<double, 6, 6> pose_covariance(const TrackerNoise& noise, const Eigen::Vector3d& place_mm) {
  const double total2 = noise.marker_mm * noise.marker_mm;
  if (noise.poses_in == PosesIn::tracker) {
    const double depth2 = noise.depth_ratio * noise.depth_ratio, side2 = total2 / (2 + depth2);
    return body_covariance({side2, side2, depth2 * side2}, noise.body_radius_mm);
  }
  // Where the sensor stands is not known in the reference's axes.
  const auto body = body_covariance(Eigen::Vector3d::Constant(total2 / 3), noise.body_radius_mm);
  Eigen::Matrix<double, 6, 6> swing = Eigen::Matrix<double, 6, 6>::Identity();
  swing.bottomLeftCorner<3, 3>() = -crossed(place_mm);
  return body + swing * body * swing.transpose();
}

}  // namespace orcart
