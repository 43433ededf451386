// The information of each point is summed, and turned round once.
#include "realtime/registration/body_covariance.hpp"

#include <Eigen/Cholesky>

namespace orcart {

TwistCovariance body_covariance(std::span<const Eigen::Vector3d> points_mm, double sigma_mm) noexcept {
  TwistCovariance information = TwistCovariance::Zero();
  for (const Eigen::Vector3d& point : points_mm) {
    Eigen::Matrix<double, 3, 6> A;
    A << Eigen::Matrix3d::Identity(), -cross_matrix(point);
    information += A.transpose() * A;
  }
  return sigma_mm * sigma_mm * information.ldlt().solve(TwistCovariance::Identity());
}

}  // namespace orcart
