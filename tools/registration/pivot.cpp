// Least squares over small random samples (RANSAC, Fischler and Bolles 1981), then over all poses that agree
// with the best.
#include "tools/registration/pivot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

double miss_mm(const NamedPose& pose, const PivotSolution& solution) {
  return (pose.X_TS.rotation * solution.tip_mm + pose.X_TS.translation_mm - solution.pivot_mm).norm();
}

Matrix6 normal_matrix(const std::vector<const NamedPose*>& poses) {
  Matrix6 normal = Matrix6::Zero();
  for (const NamedPose* pose : poses) {
    normal.topRightCorner<3, 3>() -= pose->X_TS.rotation.transpose();
    normal.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
    normal.bottomRightCorner<3, 3>() += Eigen::Matrix3d::Identity();
  }
  normal.bottomLeftCorner<3, 3>() = normal.topRightCorner<3, 3>().transpose();
  return normal;
}

PivotSolution solve(const std::vector<const NamedPose*>& poses) {
  const Matrix6 normal = normal_matrix(poses);
  Vector6 right = Vector6::Zero();
  for (const NamedPose* pose : poses) {
    right.head<3>() -= pose->X_TS.rotation.transpose() * pose->X_TS.translation_mm;
    right.tail<3>() += pose->X_TS.translation_mm;
  }
  const Matrix6 inverse = normal.inverse();
  const Vector6 solved = inverse * right;
  PivotSolution solution{.tip_mm = solved.head<3>(), .pivot_mm = solved.tail<3>(), .poses = poses.size()};
  double sum2 = 0;
  for (const NamedPose* pose : poses) {
    const double miss = miss_mm(*pose, solution);
    sum2 += miss * miss;
    solution.worst_mm = std::max(solution.worst_mm, miss);
  }
  const auto count = static_cast<double>(poses.size());
  solution.rms_mm = std::sqrt(sum2 / count);
  solution.rms_component_mm = std::sqrt(sum2 / (3 * count));
  const double variance = sum2 / std::max(1.0, 3 * count - 6);
  solution.deviation_mm = (variance * inverse.diagonal().head<3>()).cwiseSqrt();
  return solution;
}

/// What two of the turns leave in common stays open: the smallest spread of the rotations tells.
Result<void> check_sweep(const std::vector<const NamedPose*>& poses, double sweep_rad) {
  constexpr double kLeastSweep_rad = 0.35;
  const double degrees = sweep_rad * 180 / std::numbers::pi;
  if (sweep_rad < kLeastSweep_rad)
    return fail(
        json::format("the pointer turned by %.1f degrees at most, which leaves its tip open; tilt it by 30 "
                     "degrees or more to "
                     "all sides",
                     degrees));
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(normal_matrix(poses) /
                                                      static_cast<double>(poses.size()));
  // With turns about one axis only, the tip may slide along it: the smallest eigenvalue is then 0.
  if (solver.eigenvalues()[0] < 2e-4)
    return fail(
        json::format("the pointer turned by %.1f degrees but about one axis only, so its tip may lie "
                     "anywhere along that axis; tilt "
                     "it to the front and the back as well as to the sides",
                     degrees));
  return {};
}

double widest_turn_rad(const std::vector<NamedPose>& poses) {
  double widest = 0;
  const std::size_t stride = std::max<std::size_t>(1, poses.size() / 150);
  for (std::size_t a = 0; a < poses.size(); a += stride)
    for (std::size_t b = a + stride; b < poses.size(); b += stride)
      widest = std::max(widest, angle_between_rad(poses[a].X_TS, poses[b].X_TS));
  return widest;
}

/// The sample whose solution leaves the smallest median miss (least median of squares, Rousseeuw 1984).
PivotSolution best_sample(const std::vector<const NamedPose*>& all, double& median_mm) {
  constexpr int kSamples = 600;
  constexpr std::size_t kSampleSize = 8;
  std::mt19937 random(1);
  PivotSolution best;
  median_mm = 1e9;
  std::vector<double> misses(all.size());
  for (int i = 0; i < kSamples; ++i) {
    std::vector<const NamedPose*> sample;
    std::sample(all.begin(), all.end(), std::back_inserter(sample), kSampleSize, random);
    const Eigen::SelfAdjointEigenSolver<Matrix6> spread(normal_matrix(sample) /
                                                        static_cast<double>(sample.size()));
    if (spread.eigenvalues()[0] < 1e-4) continue;
    const PivotSolution tried = solve(sample);
    for (std::size_t k = 0; k < all.size(); ++k) misses[k] = miss_mm(*all[k], tried);
    std::nth_element(misses.begin(), misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2),
                     misses.end());
    if (misses[misses.size() / 2] < median_mm) median_mm = misses[misses.size() / 2], best = tried;
  }
  return best;
}

}  // namespace

Result<PivotFit> fit_pivot(const std::vector<NamedPose>& poses) {
  constexpr std::size_t kFewest = 8;
  if (poses.size() < kFewest)
    return fail("there are " + std::to_string(poses.size()) +
                " poses; eight or more are accepted, a sweep of some hundred is good");
  std::vector<const NamedPose*> all;
  for (const NamedPose& pose : poses) all.push_back(&pose);
  PivotFit fit{.sweep_rad = widest_turn_rad(poses)};
  if (auto checked = check_sweep(all, fit.sweep_rad); !checked) return tl::unexpected(checked.error());
  fit.all = solve(all);
  double median_mm = 0;
  fit.robust = best_sample(all, median_mm);
  if (median_mm >= 1e9) fit.robust = fit.all, median_mm = fit.all.worst_mm;
  for (int round = 0; round < 10; ++round) {
    std::vector<double> misses;
    for (const NamedPose* pose : all) misses.push_back(miss_mm(*pose, fit.robust));
    std::nth_element(misses.begin(), misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2),
                     misses.end());
    fit.inlier_mm = std::max(0.3, 2.0 * misses[misses.size() / 2]);
    std::vector<const NamedPose*> agreeing;
    for (const NamedPose* pose : all)
      if (miss_mm(*pose, fit.robust) <= fit.inlier_mm) agreeing.push_back(pose);
    if (2 * agreeing.size() < all.size()) break;
    const std::size_t before = fit.robust.poses;
    fit.robust = solve(agreeing);
    if (auto checked = check_sweep(agreeing, fit.sweep_rad); !checked) return tl::unexpected(checked.error());
    if (fit.robust.poses == before) break;
  }
  return fit;
}

}  // namespace orcart
