// Small rigid motions, and how their covariances are carried along a chain of poses.
#pragma once

#include "realtime/geometry/pose.hpp"

namespace orcart {

/// A small rigid motion: translation (mm), then rotation vector (rad), applied on the right of a pose, so in
/// the axes and about the origin of the pose's second frame.
using Twist = Eigen::Matrix<double, 6, 1>;

/// Of a Twist: mm^2, mm rad and rad^2.
using TwistCovariance = Eigen::Matrix<double, 6, 6>;

/// [v]x: the matrix that takes a vector to its cross product with v.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) noexcept {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// A pose moved by a twist in its own second frame: X exp(twist), the translation not bent by the rotation.
template <class A, class B>
Pose<A, B> moved(const Pose<A, B>& X_AB, const Twist& twist) {
  const Eigen::Vector3d turn = twist.tail<3>();
  const double angle = turn.norm();
  const Eigen::Matrix3d rotation =
      angle < 1e-15 ? Eigen::Matrix3d::Identity() : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  return {.rotation = X_AB.rotation * rotation,
          .translation_mm = X_AB.rotation * twist.head<3>() + X_AB.translation_mm};
}

/// The twist by which moved() takes the first pose to the second.
template <class A, class B>
Twist twist_between(const Pose<A, B>& from, const Pose<A, B>& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(from.rotation.transpose() * to.rotation));
  Twist twist;
  twist << from.rotation.transpose() * (to.translation_mm - from.translation_mm), turn.angle() * turn.axis();
  return twist;
}

/// Takes a twist in A to the one in B that does the same: moved(I_AA, t) X_AB = moved(X_AB, result t), to
/// first order (the inverse adjoint; Murray, Li and Sastry 1994, equation 2.58). Nothing allocates.
template <class A, class B>
Eigen::Matrix<double, 6, 6> twist_seen_from(const Pose<A, B>& X_AB) noexcept {
  Eigen::Matrix<double, 6, 6> seen = Eigen::Matrix<double, 6, 6>::Zero();
  seen.template topLeftCorner<3, 3>() = X_AB.rotation.transpose();
  seen.template bottomRightCorner<3, 3>() = X_AB.rotation.transpose();
  seen.template topRightCorner<3, 3>() = -X_AB.rotation.transpose() * cross_matrix(X_AB.translation_mm);
  return seen;
}

/// The covariance of a twist in A, seen from B.
template <class A, class B>
TwistCovariance covariance_seen_from(const Pose<A, B>& X_AB, const TwistCovariance& in_A) noexcept {
  const Eigen::Matrix<double, 6, 6> seen = twist_seen_from(X_AB);
  return seen * in_A * seen.transpose();
}

}  // namespace orcart
