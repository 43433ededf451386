// The weights reach three standard deviations; rotations are fitted as small turns about the nearest
// sample's.
#include "tools/calibration/pose_track.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace orcart {
namespace {

constexpr double kEdge = 1.5;    ///< kept clear of, in standard deviations
constexpr double kReach = 3;     ///< of the weights, in standard deviations
constexpr double kGapLimit = 4;  ///< between neighbours, in standard deviations

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

}  // namespace

PoseTrack::PoseTrack(std::vector<TrackedPose> samples, double smooth_s)
    : samples_(std::move(samples)), smooth_s_(smooth_s) {
  const auto gap = [&](std::size_t i) {
    return samples_[i].at_s - samples_[i - 1].at_s > kGapLimit * smooth_s_;
  };
  for (std::size_t i = 0; i < samples_.size(); ++i)
    run_begins_s_.push_back(i == 0 || gap(i) ? samples_[i].at_s : run_begins_s_.back());
  run_ends_s_.resize(samples_.size());
  for (std::size_t i = samples_.size(); i > 0; --i)
    run_ends_s_[i - 1] = i == samples_.size() || gap(i) ? samples_[i - 1].at_s : run_ends_s_[i];
}

std::optional<Pose<T, S>> PoseTrack::at(double t_s) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t_s,
                                      [](const TrackedPose& s, double t) { return s.at_s < t; });
  if (after == samples_.end() || (after == samples_.begin() && after->at_s > t_s)) return std::nullopt;
  const auto before = after == samples_.begin() ? after : after - 1;
  const auto number = static_cast<std::size_t>(after - samples_.begin());
  if (t_s - run_begins_s_[number] < kEdge * smooth_s_ || run_ends_s_[number] - t_s < kEdge * smooth_s_)
    return std::nullopt;
  const TrackedPose& nearest = t_s - before->at_s < after->at_s - t_s ? *before : *after;

  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> right = Eigen::Matrix<double, 3, 6>::Zero();
  int used = 0;
  const auto add = [&](const TrackedPose& sample) {
    const double u = (sample.at_s - t_s) / smooth_s_;
    const double weight = std::exp(-0.5 * u * u);
    const Eigen::Vector3d basis(1, u, u * u);
    Eigen::Matrix<double, 1, 6> value;
    value.head<3>() = (sample.X_TS.translation_mm - nearest.X_TS.translation_mm).transpose();
    value.tail<3>() = rotation_vector(nearest.X_TS.rotation.transpose() * sample.X_TS.rotation).transpose();
    normal += weight * basis * basis.transpose();
    right += weight * basis * value;
    ++used;
  };
  for (auto one = after; one != samples_.end() && one->at_s - t_s <= kReach * smooth_s_; ++one) add(*one);
  for (auto one = after; one != samples_.begin() && t_s - (one - 1)->at_s <= kReach * smooth_s_; --one)
    add(*(one - 1));
  if (used < 4) return std::nullopt;
  const Eigen::Matrix<double, 1, 6> here = normal.ldlt().solve(right).row(0);
  return Pose<T, S>{.rotation = nearest.X_TS.rotation * rotation_of(here.tail<3>().transpose()),
                    .translation_mm = nearest.X_TS.translation_mm + here.head<3>().transpose()};
}

double smoothing_s(double period_s) {
  return std::max({0.015, 1.2 * period_s, std::min(2 * period_s, 0.035)});
}

double usual_period_s(const std::vector<TrackedPose>& samples) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) steps.push_back(samples[i].at_s - samples[i - 1].at_s);
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace orcart
