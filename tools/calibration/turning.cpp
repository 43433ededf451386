// Ceres for what the pictures say, linear algebra for what the marker's poses leave fixed.
#include "tools/calibration/turning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <ceres/ceres.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <opencv2/imgproc.hpp>

#include "realtime/optics/scope_turn.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/students_t.hpp"

namespace orcart {
namespace {

constexpr std::size_t kFewestPictures = 3, kFewestShared = 6;
constexpr double kLeastRange_rad = 40 * std::numbers::pi / 180, kLargestRms_px = 1, kLeastSure_px = 1;
constexpr double kMarkerAgrees_rad = std::numbers::pi / 180, kNormal95 = 1.96;
constexpr double kClearly = 4;  ///< in squares: that one sign of an axis fits better than the other

double wrapped(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}
double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

/// A corner at turn 0 goes round the centre and lands where it was seen. Square pixels.
struct GoesRound {
  double x, y;
  template <class T>
  bool operator()(const T* centre, const T* turn, const T* place, T* off) const {
    const T c = cos(turn[0]), s = sin(turn[0]), dx = place[0] - centre[0], dy = place[1] - centre[1];
    off[0] = centre[0] + c * dx - s * dy - x;
    off[1] = centre[1] + s * dx + c * dy - y;
    return true;
  }
};

using Places = std::map<std::pair<int, int>, std::array<double, 2>>;

Places places_of(const TurnSight& sight, double aspect) {
  Places places;
  for (const BoardCorner& c : sight.corners)
    places[{c.lattice.x(), c.lattice.y()}] = {c.pixel_px.x(), c.pixel_px.y() / aspect};
  return places;
}

/// The turn between two pictures by the corners that both show: the 2-D rigid transform's angle.
std::optional<double> turn_between(const Places& from, const Places& to) {
  Eigen::Vector2d mean_from = Eigen::Vector2d::Zero(), mean_to = Eigen::Vector2d::Zero();
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> shared;
  for (const auto& [key, place] : from) {
    const auto other = to.find(key);
    if (other == to.end()) continue;
    shared.emplace_back(Eigen::Vector2d(place[0], place[1]),
                        Eigen::Vector2d(other->second[0], other->second[1]));
    mean_from += shared.back().first, mean_to += shared.back().second;
  }
  if (shared.size() < kFewestShared) return std::nullopt;
  mean_from /= static_cast<double>(shared.size()), mean_to /= static_cast<double>(shared.size());
  double along = 0, across = 0;
  for (const auto& [a, b] : shared) {
    const Eigen::Vector2d p = a - mean_from, q = b - mean_to;
    along += p.dot(q);
    across += p.x() * q.y() - p.y() * q.x();
  }
  return std::atan2(across, along);
}

/// What the pictures say: centre (square pixels), turns since the first picture, residuals.
struct PictureFit {
  std::array<double, 2> centre{};
  std::vector<double> turns_rad, each_px;
  double rms_px = 0, deviation_px = 0;
};

Result<PictureFit> fit_pictures(const std::vector<TurnSight>& sights, double aspect) {
  std::vector<Places> seen;
  seen.reserve(sights.size());
  for (const TurnSight& sight : sights) seen.push_back(places_of(sight, aspect));
  PictureFit fit{.turns_rad = std::vector<double>(sights.size(), 0.0)};
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t k = 1; k < seen.size(); ++k) {
    const auto turn = turn_between(seen.front(), seen[k]);
    if (!turn)
      return fail(sights[k].name + ": shares fewer than " + std::to_string(kFewestShared) + " corners with " +
                  sights.front().name + "; the board must stay in view while the head turns");
    fit.turns_rad[k] = *turn;
    // The centre c stays: (I - R) c = p - R q for every corner.
    const Eigen::Matrix2d left = Eigen::Matrix2d::Identity() - Eigen::Rotation2Dd(*turn).toRotationMatrix();
    for (const auto& [key, place] : seen.front()) {
      const auto other = seen[k].find(key);
      if (other == seen[k].end()) continue;
      const Eigen::Vector2d moved = Eigen::Vector2d(other->second[0], other->second[1]) -
                                    Eigen::Rotation2Dd(*turn) * Eigen::Vector2d(place[0], place[1]);
      normal += left.transpose() * left;
      right += left.transpose() * moved;
    }
  }
  const Eigen::Vector2d centre = (normal + 1e-9 * Eigen::Matrix2d::Identity()).ldlt().solve(right);
  fit.centre = {centre.x(), centre.y()};

  Places at_zero = seen.front();
  for (std::size_t k = 1; k < seen.size(); ++k)
    for (const auto& [key, place] : seen[k]) {
      const Eigen::Vector2d back =
          centre + Eigen::Rotation2Dd(-fit.turns_rad[k]) * (Eigen::Vector2d(place[0], place[1]) - centre);
      at_zero.try_emplace(key, std::array<double, 2>{back.x(), back.y()});
    }
  ceres::Problem problem;
  for (std::size_t k = 0; k < seen.size(); ++k)
    for (const auto& [key, place] : seen[k])
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<GoesRound, 2, 2, 1, 2>(new GoesRound{place[0], place[1]}), nullptr,
          fit.centre.data(), &fit.turns_rad[k], at_zero.at(key).data());
  problem.SetParameterBlockConstant(&fit.turns_rad[0]);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::size_t all = 0;
  double squares = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    double own = 0;
    for (const auto& [key, place] : seen[k]) {
      std::array<double, 2> off{};
      GoesRound{place[0], place[1]}(fit.centre.data(), &fit.turns_rad[k], at_zero.at(key).data(), off.data());
      own += off[0] * off[0] + off[1] * off[1];
    }
    fit.each_px.push_back(std::sqrt(own / static_cast<double>(seen[k].size())));
    squares += own, all += seen[k].size();
  }
  fit.rms_px = std::sqrt(squares / static_cast<double>(all));
  ceres::Covariance covariance({});
  std::array<double, 4> block{1e9, 0, 0, 1e9};
  const double freedom = 2.0 * static_cast<double>(all) - 2.0 * static_cast<double>(at_zero.size()) -
                         static_cast<double>(seen.size()) - 1;
  const std::vector<const double*> wanted{fit.centre.data()};
  if (covariance.Compute(wanted, &problem))
    covariance.GetCovarianceBlock(fit.centre.data(), fit.centre.data(), block.data());
  fit.deviation_px = std::sqrt(squares / std::max(1.0, freedom) * std::max(block[0], block[3]));
  return fit;
}

/// Mean square of how far a marker on the head turns otherwise about an axis than the pictures do.
double angles2_about(const Eigen::Vector3d& axis, const std::vector<TurnSight>& sights,
                     const TurningFit& fit) {
  double angles2 = 0;
  for (std::size_t k = 1; k < sights.size(); ++k) {
    const Eigen::Matrix3d moved = sights[0].X_TS->rotation.transpose() * sights[k].X_TS->rotation;
    const Eigen::Matrix3d expected =
        Eigen::AngleAxisd(-wrapped(fit.turns_rad[k] - fit.turns_rad[0]), axis).toRotationMatrix();
    const double off = Eigen::AngleAxisd(Eigen::Matrix3d(moved.transpose() * expected)).angle();
    angles2 += off * off / static_cast<double>(sights.size() - 1);
  }
  return angles2;
}

/// The axis that the marker's poses leave fixed. The scope stands still in T, so X_TS(k) A(turn k) is the
/// same for all: the marker turns by minus the picture's turn.
Result<void> fit_axis(const std::vector<TurnSight>& sights, const TurningTask& task, TurningFit& fit) {
  const auto count = static_cast<Eigen::Index>(sights.size());
  Eigen::MatrixX3d fixed_way(3 * count * (count - 1) / 2, 3);
  Eigen::VectorXd shift(fixed_way.rows());
  Eigen::Index row = 0;
  for (std::size_t a = 0; a < sights.size(); ++a)
    for (std::size_t b = a + 1; b < sights.size(); ++b, row += 3) {
      const Pose<S, S> moved = sights[a].X_TS->inverse() * *sights[b].X_TS;
      fixed_way.middleRows<3>(row) = moved.rotation - Eigen::Matrix3d::Identity();
      shift.segment<3>(row) = -moved.translation_mm;
    }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(fixed_way, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Turning& turning = fit.turning;
  turning.axis = svd.matrixV().col(2);
  // The point of least squares across the axis; along it nothing is told, and the origin's height is taken.
  const Eigen::MatrixXd across = svd.matrixV().leftCols(2);
  turning.axis_point_mm = across * (fixed_way * across).colPivHouseholderQr().solve(shift);
  // A view of over 90 degrees looks back along the shaft, so it is the turns that tell which way the axis
  // goes, unless all are half turns.
  if (turning.axis.dot(task.view_S) < 0) turning.axis = -turning.axis;
  if (angles2_about(turning.axis, sights, fit) > kClearly * angles2_about(-turning.axis, sights, fit))
    turning.axis = -turning.axis;

  const double angles = angles2_about(turning.axis, sights, fit);
  double places = 0;
  for (std::size_t k = 1; k < sights.size(); ++k) {
    const Pose<S, S> moved = sights[0].X_TS->inverse() * *sights[k].X_TS;
    places += (moved.rotation * turning.axis_point_mm + moved.translation_mm - turning.axis_point_mm)
                  .squaredNorm() /
              static_cast<double>(sights.size() - 1);
  }
  fit.angle_rms_rad = std::sqrt(angles), fit.axis_rms_mm = std::sqrt(places);
  if (fit.angle_rms_rad > kMarkerAgrees_rad)
    return fail(json::format(
        "the marker turns otherwise than the picture, by %.1f degrees RMS (%.1f are accepted): poses and "
        "pictures do not belong together, the scope moved, or the marker sits on the shaft (leave --poses "
        "out)",
        degrees(fit.angle_rms_rad), degrees(kMarkerAgrees_rad)));
  return {};
}

Eigen::Matrix3d between_markers(const TurnSight& sight) {
  return sight.X_TS->rotation.transpose() * sight.X_TL->rotation;
}

/// With the marker on the shaft, the axis that the second one, on the head, turns about: what its rotations
/// in S leave fixed; its sign is by the view until fit_second().
void fit_axis_by_second(const std::vector<TurnSight>& sights, const TurningTask& task, TurningFit& fit) {
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < sights.size(); ++a)
    for (std::size_t b = a + 1; b < sights.size(); ++b) {
      const Eigen::Matrix3d moved =
          between_markers(sights[b]) * between_markers(sights[a]).transpose() - Eigen::Matrix3d::Identity();
      turned += moved.transpose() * moved;
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(turned);
  fit.turning.axis = solved.eigenvectors().col(0);
  if (fit.turning.axis.dot(task.view_S) < 0) fit.turning.axis = -fit.turning.axis;
}

/// Where the second marker is at turn 0: the mean of what each picture says, its turn taken off. The RMS of
/// its turns about the pictures'.
double place_second(const std::vector<TurnSight>& sights, const TurningFit& fit, Turning& turning) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  turning.R_SL.reset();
  for (std::size_t k = 0; k < sights.size(); ++k)
    sum += second_marker_at(turning, -fit.turns_rad[k]) *
           between_markers(sights[k]);  // no R_SL yet: the turn alone
  turning.R_SL = nearest_rotation(sum).rotation;
  double squares = 0;
  for (std::size_t k = 0; k < sights.size(); ++k) {
    const MarkedTurn told = turn_of(turning, between_markers(sights[k]));
    squares += std::pow(wrapped(told.turn_rad - fit.turns_rad[k]), 2) + std::pow(told.swing_rad, 2);
  }
  return std::sqrt(squares / static_cast<double>(sights.size()));
}

/// Both markers; with the scope's own on the shaft the turns tell which way the axis goes.
Result<void> fit_second(const std::vector<TurnSight>& sights, TurningFit& fit) {
  fit.second_rms_rad = place_second(sights, fit, fit.turning);
  if (fit.turning.marker == TurnMarker::shaft) {
    Turning other = fit.turning;
    other.axis = -other.axis;
    const double rms_rad = place_second(sights, fit, other);
    if (fit.second_rms_rad * fit.second_rms_rad > kClearly * rms_rad * rms_rad)
      fit.turning = other, fit.second_rms_rad = rms_rad;
  }
  if (fit.second_rms_rad <= kMarkerAgrees_rad) return {};
  return fail(
      json::format("the second marker turns otherwise than the picture, by %.1f degrees RMS (%.1f are "
                   "accepted): it is not on "
                   "the other side of the coupler, it moved on its part, or --marker is the other way round",
                   degrees(fit.second_rms_rad), degrees(kMarkerAgrees_rad)));
}

/// Where turn 0 is, by the notch where passport and pictures have one.
void set_zero(const std::vector<TurnSight>& sights, const TurningTask& task, TurningFit& fit) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::size_t found = 0;
  for (std::size_t k = 0; k < sights.size(); ++k) {
    if (!sights[k].notch_rad) continue;
    const double zero = *sights[k].notch_rad - fit.turns_rad[k];
    sum += Eigen::Vector2d(std::cos(zero), std::sin(zero));
    ++found;
  }
  if (2 * found <= sights.size()) {
    fit.notes.emplace_back("no notch was found, so the first picture counts as turn 0: that of the passport");
    return;
  }
  const double mean = std::atan2(sum.y(), sum.x());
  double squares = 0;
  for (std::size_t k = 0; k < sights.size(); ++k)
    if (sights[k].notch_rad) squares += std::pow(wrapped(*sights[k].notch_rad - fit.turns_rad[k] - mean), 2);
  fit.notch_rms_rad = std::sqrt(squares / static_cast<double>(found));
  fit.notch_zero_rad = mean;
  // Few pictures know their own scatter badly: as much wider as Student's 95 % is than the normal one.
  if (found >= kFewestPictures)
    fit.turning.notch_deviation_rad =
        students_t(found - 1) / kNormal95 * std::sqrt(squares / static_cast<double>(found - 1));
  if (!task.passport_notch_rad) {
    fit.notes.emplace_back("the passport has no notch yet, so the first picture counts as turn 0");
    return;
  }
  fit.notch_zero_rad = task.passport_notch_rad;
  for (double& turn : fit.turns_rad) turn += mean - *task.passport_notch_rad;
}

}  // namespace

Result<TurningFit> fit_turning(const std::vector<TurnSight>& sights, const TurningTask& task) {
  if (sights.size() < kFewestPictures)
    return fail("too few pictures with the board: " + std::to_string(sights.size()) +
                "; three or more at different turns are accepted");
  const auto pictures = fit_pictures(sights, task.aspect);
  if (!pictures) return tl::unexpected(pictures.error());
  TurningFit fit{.turns_rad = pictures->turns_rad, .rms_px = pictures->rms_px, .each_px = pictures->each_px};
  for (const double a : fit.turns_rad)
    for (const double b : fit.turns_rad) fit.range_rad = std::max(fit.range_rad, std::abs(wrapped(a - b)));
  if (fit.range_rad < kLeastRange_rad)
    return fail(
        json::format("the head turns by %.0f degrees only; 40 or more are accepted, all round is good",
                     degrees(fit.range_rad)));
  if (fit.rms_px > kLargestRms_px)
    return fail(
        json::format("the corners do not go round one centre (%.1f px RMS, up to %.0f is accepted): the "
                     "scope or the board "
                     "moved; clamp both and turn the camera head alone",
                     fit.rms_px, kLargestRms_px));
  if (pictures->deviation_px > kLeastSure_px)
    return fail(json::format("the centre is known to +-%.1f px only; up to %.0f is accepted: add turns",
                             pictures->deviation_px, kLeastSure_px));
  fit.turning = {.view_angle_rad = task.view_angle_rad,
                 .centre_px = {pictures->centre[0], pictures->centre[1] * task.aspect},
                 .centre_deviation_px = pictures->deviation_px,
                 .marker = task.marker};
  if (task.marker == TurnMarker::head)
    if (auto axis = fit_axis(sights, task, fit); !axis) return tl::unexpected(axis.error());
  const bool second = std::ranges::all_of(sights, [](const TurnSight& s) { return s.X_TS && s.X_TL; });
  if (second && task.marker == TurnMarker::shaft) fit_axis_by_second(sights, task, fit);
  set_zero(sights, task, fit);
  for (double& turn : fit.turns_rad) turn = wrapped(turn);
  if (second)
    if (auto found = fit_second(sights, fit); !found) return tl::unexpected(found.error());
  return fit;
}

Result<double> turn_by_notch(const cv::Mat& picture, const ScopeModel& scope) {
  if (!scope.turning || !scope.notch_rad)
    return fail("the passport has no [turning] or no notch; run orcart calibrate turn");
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  const FoundMask found = find_mask(grey, scope.lens.fy_px / scope.lens.fx_px);
  if (!found.notch_rad)
    return fail("no notch is found on the circle's edge; light the whole circle, or state the turn");
  return wrapped(*found.notch_rad - *scope.notch_rad);
}

}  // namespace orcart
