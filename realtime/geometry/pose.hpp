// Rigid transforms whose frames are part of their type, so that a wrong chain does not compile.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "realtime/geometry/frames.hpp"

namespace orcart {

/// X_AB: takes coordinates in B to coordinates in A. p_A = rotation * p_B + translation_mm.
template <class A, class B>
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();    ///< R_AB; columns are B's axes seen from A
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();  ///< B's origin, in A

  Pose<B, A> inverse() const {
    return {.rotation = rotation.transpose(), .translation_mm = -(rotation.transpose() * translation_mm)};
  }
  Point<A> operator*(const Point<B>& p) const { return {rotation * p.mm + translation_mm}; }
  Direction<A> operator*(const Direction<B>& d) const { return {rotation * d.xyz}; }
};

/// X_AC = X_AB * X_BC: the neighbours match.
template <class A, class B, class D>
Pose<A, D> operator*(const Pose<A, B>& X_AB, const Pose<B, D>& X_BD) {
  return {.rotation = X_AB.rotation * X_BD.rotation,
          .translation_mm = X_AB.rotation * X_BD.translation_mm + X_AB.translation_mm};
}

/// From a unit quaternion (w, x, y, z) and a translation, as NDI devices report them.
template <class A, class B>
Pose<A, B> pose_from_quaternion(const Eigen::Quaterniond& q_AB, const Eigen::Vector3d& translation_mm) {
  return {.rotation = q_AB.normalized().toRotationMatrix(), .translation_mm = translation_mm};
}

/// Between two poses at fraction 0..1: translation on a line, rotation by slerp (Shoemake 1985).
template <class A, class B>
Pose<A, B> interpolate(const Pose<A, B>& from, const Pose<A, B>& to, double fraction) {
  const Eigen::Quaterniond a(from.rotation), b(to.rotation);
  return {.rotation = a.slerp(fraction, b).toRotationMatrix(),
          .translation_mm = from.translation_mm + fraction * (to.translation_mm - from.translation_mm)};
}

/// The angle of the rotation between two poses, radians, 0..pi.
template <class A, class B>
double angle_between_rad(const Pose<A, B>& a, const Pose<A, B>& b) {
  return Eigen::Quaterniond(a.rotation).angularDistance(Eigen::Quaterniond(b.rotation));
}

/// The rotation nearest to a 3x3 matrix (polar decomposition by SVD), and how far |R'R - I| (largest entry)
/// it was from one. A deviation beyond 0.01, or a reflection, is the caller's to refuse. A matrix that is not
/// finite deviates infinitely.
struct NearestRotation {
  Eigen::Matrix3d rotation;
  double deviation = 0.0;
  bool reflected = false;
};
NearestRotation nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace orcart
