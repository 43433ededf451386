// Step 3: the rigid transform that best takes one list of points to another.
#pragma once

#include <span>

#include <Eigen/Core>

#include "realtime/base/result.hpp"

namespace orcart {

/// p_to = rotation * p_from + translation_mm.
struct RigidFit {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  double fre_mm = 0;  ///< fiducial registration error: root mean square of the distances left over
};

/// Pairs of points, mm, in the same order.
struct PointPairs {
  std::span<const Eigen::Vector3d> from_mm;
  std::span<const Eigen::Vector3d> to_mm;
};

/// Least squares in closed form (Umeyama 1991, without scale; the answer of Horn 1987), never a reflection.
/// Refuses lists of different length, fewer than three pairs, coordinates that are not numbers, and points of
/// either list that lie on one line, about which nothing fixes the turn. Off the real-time path.
Result<RigidFit> rigid_fit(const PointPairs& pairs);

}  // namespace orcart
