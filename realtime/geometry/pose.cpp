// The nearest rotation to a matrix that should be one: the gate for poses that come from files.
#include "realtime/geometry/pose.hpp"

#include <cmath>

#include <Eigen/SVD>

namespace orcart {

NearestRotation nearest_rotation(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite())
    return {.rotation = Eigen::Matrix3d::Identity(), .deviation = HUGE_VAL, .reflected = false};
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d polar = svd.matrixU() * svd.matrixV().transpose();
  NearestRotation nearest;
  nearest.deviation = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  nearest.reflected = polar.determinant() < 0;
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (nearest.reflected) signs.z() = -1;  // the smallest singular value gives way (Umeyama 1991)
  nearest.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return nearest;
}

}  // namespace orcart
