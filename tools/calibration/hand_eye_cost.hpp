// The joint problem of lens, board poses, hand-eye and board place; the marker's poses are measurements with
// noise.
#pragma once

#include <ceres/ceres.h>
#include <Eigen/Geometry>

#include "tools/calibration/hand_eye.hpp"

namespace orcart::hand_eye {

using Block = std::array<double, 6>;

template <class A, class D>
Block block_of(const Pose<A, D>& X) {
  const Eigen::AngleAxisd turn(X.rotation);
  const Eigen::Vector3d r = turn.angle() * turn.axis(), &t = X.translation_mm;
  return {r.x(), r.y(), r.z(), t.x(), t.y(), t.z()};
}

template <class A, class D>
Pose<A, D> pose_of(const Block& b) {
  const Eigen::Vector3d r(b[0], b[1], b[2]);
  const double angle = r.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(r / angle) : Eigen::Vector3d::UnitX();
  return {.rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix(),
          .translation_mm = {b[3], b[4], b[5]}};
}

struct PixelCost {
  LensModel model;
  Eigen::Vector2d pixel;
  Eigen::Vector3d place;
  double sigma_px;
  template <class Number>
  bool operator()(const Number* intrinsics, const Number* X_CB, Number* residual) const {
    Number p[3], seen[2];
    lens_cost::transform(X_CB, place.data(), p);
    if (!lens_cost::project(model, intrinsics, p, seen)) return false;
    residual[0] = (seen[0] - pixel.x()) / sigma_px;
    residual[1] = (seen[1] - pixel.y()) / sigma_px;
    return true;
  }
};

/// The measured marker pose against the one that board, camera and hand-eye imply: X_TS = X_TB X_BC X_CS.
struct MarkerCost {
  Block measured;
  Eigen::Matrix<double, 6, 6> whitening;  ///< of turn and shift in the tracker's axes
  template <class Number>
  bool operator()(const Number* X_CB, const Number* X_SC, const Number* X_TB, Number* residual) const {
    Number tb[4], cb[4], sc[4], bc[4], cs[4], tc[4], ts[4], st[4], off[4], a[3], b[3], error[6];
    ceres::AngleAxisToQuaternion(X_TB, tb);
    ceres::AngleAxisToQuaternion(X_CB, cb);
    ceres::AngleAxisToQuaternion(X_SC, sc);
    conjugate(cb, bc);
    conjugate(sc, cs);
    ceres::QuaternionProduct(tb, bc, tc);
    ceres::QuaternionProduct(tc, cs, ts);
    // The marker's origin: -R_CS t_SC in the camera, then on through board and tracker.
    ceres::QuaternionRotatePoint(cs, X_SC + 3, a);
    for (int i = 0; i < 3; ++i) a[i] = -a[i] - X_CB[3 + i];
    ceres::QuaternionRotatePoint(bc, a, b);
    ceres::QuaternionRotatePoint(tb, b, error + 3);
    const Number given[3] = {Number(measured[0]), Number(measured[1]), Number(measured[2])};
    Number gq[4];
    ceres::AngleAxisToQuaternion(given, gq);
    conjugate(gq, st);
    ceres::QuaternionProduct(ts, st, off);
    ceres::QuaternionToAngleAxis(off, error);
    for (int i = 0; i < 3; ++i) error[3 + i] += X_TB[3 + i] - measured[static_cast<std::size_t>(3 + i)];
    for (int i = 0; i < 6; ++i) {
      residual[i] = Number(0);
      for (int j = 0; j <= i; ++j) residual[i] += whitening(i, j) * error[j];
    }
    return true;
  }
  template <class Number>
  static void conjugate(const Number* q, Number* result) {
    result[0] = q[0];
    for (int i = 1; i < 4; ++i) result[i] = -q[i];
  }
};

/// The unknowns at their start, and the problem over them. Stays where it is made: Ceres keeps pointers to
/// it.
struct JointProblem {
  JointProblem(const std::vector<HandEyeView>& views, const HandEyeFit& start, const RefineTask& task);
  JointProblem(const JointProblem&) = delete;
  JointProblem& operator=(const JointProblem&) = delete;

  Intrinsics intrinsics;
  Block hand_eye, board;       ///< X_SC, X_TB
  std::vector<Block> cameras;  ///< X_CB of each view
  ceres::Problem problem;
  std::vector<ceres::ResidualBlockId> markers, corners;
};

}  // namespace orcart::hand_eye
