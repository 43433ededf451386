// Board: a rigid transform between two lists of places. Features: the place at rest that explains what was
// seen.
#include "tools/calibration/movement_misfit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace orcart {
namespace {

constexpr double kTurnArm_mm = 100;  ///< a turn counts as what it moves at this distance
constexpr double kShortest_s = 0.2, kLongest_s = 2.5, kTurnAround_s = 0.3, kLeastWay_mm = 5;
constexpr double kFixedByRigid = 6, kFixedByFeature = 3;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr double kUsualNearness_per_mm = 0.02;  ///< of a feature: where its search begins

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// The marker at the instant for each lag; empty where the track does not know one of them.
std::vector<Pose<T, S>> at_all(const PoseTrack& track, double at_s, std::span<const double> lags_s) {
  std::vector<Pose<T, S>> poses;
  for (const double lag : lags_s) {
    const auto pose = track.at(at_s + lag);
    if (!pose) return {};
    poses.push_back(*pose);
  }
  return poses;
}

/// What a rigid transform leaves between two lists of places (columns): Horn 1987, by the largest eigenvalue
/// of his symmetric matrix; a reflection is none of its answers.
double rigid_rest(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& y) {
  const Eigen::Matrix3Xd xc = x.colwise() - x.rowwise().mean(), yc = y.colwise() - y.rowwise().mean();
  const Eigen::Matrix3d m = xc * yc.transpose();
  const Eigen::Vector3d turned(m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0));
  Eigen::Matrix4d n;
  n(0, 0) = m.trace();
  n.block<3, 1>(1, 0) = turned;
  n.block<1, 3>(0, 1) = turned.transpose();
  n.block<3, 3>(1, 1) = m + m.transpose() - m.trace() * Eigen::Matrix3d::Identity();
  const double most =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n, Eigen::EigenvaluesOnly).eigenvalues()[3];
  return std::max(0.0, xc.squaredNorm() + yc.squaredNorm() - 2 * most);
}

MisfitCurve board_curve(const PoseTrack& track, const std::vector<BoardSight>& sights,
                        const Stretch_s& window, const MisfitTask& task) {
  std::vector<std::vector<Pose<T, S>>> poses;
  std::vector<const BoardSight*> used;
  for (const BoardSight& sight : sights) {
    if (sight.at_s < window.from_s || sight.at_s > window.to_s) continue;
    auto at = at_all(track, sight.at_s, task.lags_s);
    if (at.empty()) continue;
    poses.push_back(std::move(at));
    used.push_back(&sight);
  }
  MisfitCurve curve{.samples = used.size()};
  const auto count = static_cast<Eigen::Index>(used.size());
  if (count == 0) return curve;
  Eigen::Matrix3Xd x(3, 2 * count), y(3, 2 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    y.col(k) = used[static_cast<std::size_t>(k)]->marker_mm;
    y.col(count + k) = used[static_cast<std::size_t>(k)]->camera_mm;
  }
  for (std::size_t i = 0; i < task.lags_s.size(); ++i) {
    for (Eigen::Index k = 0; k < count; ++k) {
      const Pose<T, S>& X_TS = poses[static_cast<std::size_t>(k)][i];
      x.col(k) = X_TS.translation_mm;
      x.col(count + k) = (X_TS * Point<S>{task.X_SC.translation_mm}).mm;
    }
    curve.squares.push_back(rigid_rest(x, y));
  }
  const Eigen::Matrix3Xd marker = y.leftCols(count), camera = y.rightCols(count);
  curve.motion = (marker.colwise() - marker.rowwise().mean()).squaredNorm() +
                 (camera.colwise() - camera.rowwise().mean()).squaredNorm();
  curve.freedom = std::max(1.0, 6.0 * static_cast<double>(count) - kFixedByRigid);
  return curve;
}

/// Turn, counted at an arm's length, and shift from one pose to another, mm.
Eigen::Matrix<double, 1, 6> twist_between(const Pose<T, S>& from, const Pose<T, S>& to) {
  const auto moved = from.inverse() * to;
  Eigen::Matrix<double, 1, 6> twist;
  twist << kTurnArm_mm * rotation_vector(moved.rotation).transpose(), moved.translation_mm.transpose();
  return twist;
}

/// The camera at each frame of a movement, for one lag: T's axes seen from C, and C in T.
struct CameraAt {
  Eigen::Matrix3d rotation_CT = Eigen::Matrix3d::Identity();
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();
};

/// A feature of one movement; frames are counted from the movement's first.
struct Followed {
  std::vector<std::size_t> frames;
  std::vector<Eigen::Vector2d> flats;
  double still = 0;  ///< sum of squares about the mean
};

/// What is left of a feature's directions when it rests at the best place: direction in its first camera and
/// inverse distance along it (Montiel, Civera and Davison 2006), by Gauss and Newton.
double resting_rest(const Followed& feature, const std::vector<CameraAt>& cameras) {
  constexpr int kRounds = 3;
  const CameraAt& first = cameras[feature.frames.front()];
  Eigen::Vector3d unknown(feature.flats.front().x(), feature.flats.front().y(), kUsualNearness_per_mm);
  for (int round = 0;; ++round) {
    Eigen::Matrix3d normal = Eigen::Vector3d(1e-9, 1e-9, 1e-4).asDiagonal();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double left = 0;
    for (std::size_t k = 0; k < feature.frames.size(); ++k) {
      const CameraAt& camera = cameras[feature.frames[k]];
      const Eigen::Matrix3d turn = camera.rotation_CT * first.rotation_CT.transpose();
      const Eigen::Vector3d aside = camera.rotation_CT * (first.place_mm - camera.place_mm);
      const Eigen::Vector3d p = turn * Eigen::Vector3d(unknown.x(), unknown.y(), 1) + unknown.z() * aside;
      const double z = std::max(p.z(), 0.05);
      const Eigen::Vector2d seen = p.head<2>() / z, off = feature.flats[k] - seen;
      left += off.squaredNorm();
      if (round == kRounds) continue;
      Eigen::Matrix3d by_unknown;
      by_unknown << turn.col(0), turn.col(1), aside;
      const Eigen::Matrix<double, 2, 3> rows = (by_unknown.topRows<2>() - seen * by_unknown.row(2)) / z;
      normal += rows.transpose() * rows;
      right += rows.transpose() * off;
    }
    if (round == kRounds) return left;
    unknown += normal.ldlt().solve(right);
  }
}

/// Frames of the window that the track knows for every lag, and the camera there: [frame][lag].
struct FramesOfWindow {
  std::vector<std::size_t> number;             ///< of each of all frames; npos where it is none of them
  std::vector<std::vector<CameraAt>> cameras;  ///< [lag][frame]
};
FramesOfWindow frames_of(const PoseTrack& track, const std::vector<double>& frames_at_s,
                         const Stretch_s& window, const MisfitTask& task) {
  FramesOfWindow frames{.number = std::vector<std::size_t>(frames_at_s.size(), kNone),
                        .cameras = std::vector<std::vector<CameraAt>>(task.lags_s.size())};
  for (std::size_t f = 0; f < frames_at_s.size(); ++f) {
    if (frames_at_s[f] < window.from_s || frames_at_s[f] > window.to_s) continue;
    const auto poses = at_all(track, frames_at_s[f], task.lags_s);
    if (poses.empty()) continue;
    frames.number[f] = frames.cameras.front().size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose<T, C> X_TC = poses[i] * task.X_SC;
      frames.cameras[i].push_back({X_TC.rotation.transpose(), X_TC.translation_mm});
    }
  }
  return frames;
}

std::vector<Followed> followed_in(const std::vector<FeaturePath>& features, const FramesOfWindow& frames) {
  constexpr std::size_t kFewestSights = 5;
  std::vector<Followed> all;
  for (const FeaturePath& path : features) {
    Followed one;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const FeatureSight& sight : path) {
      if (frames.number[sight.frame] == kNone) continue;
      one.frames.push_back(frames.number[sight.frame]);
      one.flats.push_back(sight.flat);
      mean += sight.flat;
    }
    if (one.frames.size() < kFewestSights) continue;
    mean /= static_cast<double>(one.flats.size());
    for (const Eigen::Vector2d& flat : one.flats) one.still += (flat - mean).squaredNorm();
    all.push_back(std::move(one));
  }
  return all;
}

/// Features slip, and highlights go their own ways: those that fit badly at their own best lag are left out.
std::vector<bool> steady(const std::vector<Followed>& features,
                         const std::vector<std::vector<double>>& squares) {
  constexpr double kWorse = 9;
  std::vector<double> least;
  least.reserve(features.size());
  for (std::size_t f = 0; f < features.size(); ++f)
    least.push_back(*std::min_element(squares[f].begin(), squares[f].end()) /
                    static_cast<double>(features[f].frames.size()));
  std::vector<double> sorted = least;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  std::vector<bool> kept;
  kept.reserve(least.size());
  for (const double one : least) kept.push_back(one <= kWorse * *middle + 1e-12);
  return kept;
}

MisfitCurve feature_curve(const PoseTrack& track, const ImageMotion& motion, const Stretch_s& window,
                          const MisfitTask& task) {
  constexpr std::size_t kFewestFeatures = 10;
  const FramesOfWindow frames = frames_of(track, motion.frames_at_s, window, task);
  const std::vector<Followed> features = followed_in(motion.features, frames);
  MisfitCurve curve{.squares = std::vector<double>(task.lags_s.size(), 0.0)};
  if (features.size() < kFewestFeatures) return curve;
  std::vector<std::vector<double>> squares;
  for (const Followed& feature : features) {
    squares.emplace_back();
    for (const auto& cameras : frames.cameras) squares.back().push_back(resting_rest(feature, cameras));
  }
  const std::vector<bool> kept = steady(features, squares);
  std::vector<bool> used(frames.cameras.front().size(), false);
  double seen = 0;
  for (std::size_t f = 0; f < features.size(); ++f) {
    if (!kept[f]) continue;
    for (std::size_t i = 0; i < curve.squares.size(); ++i) curve.squares[i] += squares[f][i];
    curve.motion += features[f].still;
    seen += 2.0 * static_cast<double>(features[f].frames.size()) - kFixedByFeature;
    for (const std::size_t frame : features[f].frames) used[frame] = true;
  }
  curve.samples = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  curve.freedom = std::max(1.0, seen);
  return curve;
}

/// The marker's pace between neighbouring samples of an even grid, mm/s.
struct Pace {
  std::vector<double> at_s, mm_s;
};
Pace pace_of(const PoseTrack& track) {
  constexpr double kStep_s = 0.02;
  Pace pace;
  std::optional<Pose<T, S>> last;
  const double first = track.samples().front().at_s, end = track.samples().back().at_s;
  const auto steps = static_cast<int>((end - first) / kStep_s);
  for (int i = 0; i <= steps; ++i) {
    const double t = first + kStep_s * i;
    const auto here = track.at(t);
    const bool both = here && last;
    pace.at_s.push_back(t);
    pace.mm_s.push_back(both ? twist_between(*last, *here).norm() / kStep_s : 0);
    last = here;
  }
  return pace;
}

double way_mm(const PoseTrack& track, const Stretch_s& stretch) {
  const auto from = track.at(stretch.from_s);
  double farthest = 0;
  constexpr int kLooks = 50;
  for (int i = 0; from && i <= kLooks; ++i)
    if (const auto here = track.at(stretch.from_s + (stretch.to_s - stretch.from_s) * i / kLooks))
      farthest = std::max(farthest, twist_between(*from, *here).norm());
  return farthest;
}

}  // namespace

MisfitCurve misfit_curve(const PoseTrack& track, const ImageMotion& motion, const Stretch_s& window,
                         const MisfitTask& task) {
  return motion.board.empty() ? feature_curve(track, motion, window, task)
                              : board_curve(track, motion.board, window, task);
}

std::vector<Stretch_s> find_movements(const PoseTrack& track) {
  std::vector<Stretch_s> found;
  if (track.samples().size() < 8) return found;
  const Pace pace = pace_of(track);
  std::vector<double> sorted = pace.mm_s;
  const auto swift = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 95 / 100);
  std::nth_element(sorted.begin(), swift, sorted.end());
  const double limit = std::max(2.0, 0.2 * *swift);
  const auto keep = [&](double from, double to) {
    if (to - from < kShortest_s || way_mm(track, {from, to}) < kLeastWay_mm) return;
    const int parts = static_cast<int>(std::ceil((to - from) / kLongest_s));
    for (int i = 0; i < parts; ++i)
      found.push_back({from + (to - from) * i / parts, from + (to - from) * (i + 1) / parts});
  };
  std::size_t began = 0, last = 0;
  bool moving = false;
  for (std::size_t i = 0; i < pace.at_s.size(); ++i) {
    if (pace.mm_s[i] > limit) {
      if (!moving) began = i;
      last = i;
      moving = true;
    }
    const bool over = pace.at_s[i] - pace.at_s[last] > kTurnAround_s || i + 1 == pace.at_s.size();
    if (moving && over) keep(pace.at_s[began], pace.at_s[last]);
    moving = moving && !over;
  }
  return found;
}

}  // namespace orcart
