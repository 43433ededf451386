// The rotation from the singular values of the points' cross covariance; reflections are turned back.
#include "realtime/registration/rigid_fit.hpp"

#include <cmath>
#include <string>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace orcart {
namespace {

/// Points whose spread across their main line is below this part of the spread along it count as lying on a
/// line.
constexpr double kSmallestSpread = 1e-3;

Eigen::Vector3d mean(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

bool on_one_line(std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d centre = mean(points);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) covariance += (p - centre) * (p - centre).transpose();
  const Eigen::Vector3d spread2 = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  return !(spread2[1] > kSmallestSpread * kSmallestSpread * spread2[0]);
}

bool all_finite(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& p : points)
    if (!p.allFinite()) return false;
  return true;
}

}  // namespace

Result<RigidFit> rigid_fit(const PointPairs& pairs) {
  const std::size_t count = pairs.from_mm.size();
  if (count != pairs.to_mm.size())
    return fail("there are " + std::to_string(count) + " points on one side and " +
                std::to_string(pairs.to_mm.size()) + " on the other; each needs its partner");
  if (count < 3)
    return fail("there are " + std::to_string(count) + " pairs of points; a rigid fit needs three or more");
  if (!all_finite(pairs.from_mm) || !all_finite(pairs.to_mm))
    return fail("a point's coordinate is not a number; every coordinate must be finite millimetres");
  if (on_one_line(pairs.from_mm) || on_one_line(pairs.to_mm))
    return fail("the " + std::to_string(count) +
                " points lie on one line, so the turn about it is open; add one beside it");

  const Eigen::Vector3d from_centre = mean(pairs.from_mm), to_centre = mean(pairs.to_mm);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i)
    cross += (pairs.to_mm[i] - to_centre) * (pairs.from_mm[i] - from_centre).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;

  RigidFit fit;
  fit.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  fit.translation_mm = to_centre - fit.rotation * from_centre;
  double left2 = 0;
  for (std::size_t i = 0; i < count; ++i)
    left2 += (fit.rotation * pairs.from_mm[i] + fit.translation_mm - pairs.to_mm[i]).squaredNorm();
  fit.fre_mm = std::sqrt(left2 / static_cast<double>(count));
  return fit;
}

}  // namespace orcart
