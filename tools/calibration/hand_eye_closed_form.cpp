// The hand-eye equation A X = X B over all pairs of views.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "tools/calibration/board_pose.hpp"
#include "tools/calibration/hand_eye.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// The marker's motion and the camera's from view i to view j.
struct Motion {
  Pose<S, S> A;
  Pose<C, C> B_camera;
};

Motion motion(const HandEyeView& i, const HandEyeView& j) {
  return {.A = j.X_TS.inverse() * i.X_TS, .B_camera = j.X_CB * i.X_CB.inverse()};
}

/// How much the marker and the camera turn otherwise between this view and the others up to `end`.
double disagreement(const HandEyeView& view, const std::vector<HandEyeView>& views, std::size_t own,
                    std::size_t end) {
  double sum = 0;
  for (std::size_t j = 0; j < end; ++j) {
    if (j == own) continue;
    const Motion m = motion(views[j], view);
    sum += std::abs(rotation_vector(m.A.rotation).norm() - rotation_vector(m.B_camera.rotation).norm());
  }
  return sum;
}

/// Turns one view's board to where it agrees best with the views before `end`; false where it was so already.
bool settle(std::vector<HandEyeView>& views, std::size_t own, std::size_t end, const Pattern& pattern) {
  HandEyeView& view = views[own];
  int best = 0;
  double least = disagreement(view, views, own, end);
  for (const int turns : turns_alike(view.board.anchor)) {
    HandEyeView tried{
        .X_TS = view.X_TS, .X_CB = view.X_CB * turned_about_middle(pattern, turns), .board = {}};
    const double off = disagreement(tried, views, own, end);
    if (turns != 0 && off < least) best = turns, least = off;
  }
  if (best == 0) return false;
  const Pose<B, B> turn = turned_about_middle(pattern, best), back = turn.inverse();
  view.X_CB = view.X_CB * turn;
  for (BoardCorner& c : view.board.corners) {
    c.board_mm = (back * Point<B>{c.board_mm}).mm;
    c.lattice = (c.board_mm.head<2>() / pattern.spacing_mm).array().round().cast<int>();
  }
  return true;
}

}  // namespace

double scatter_mm(const std::vector<HandEyeView>& views, const Pose<S, C>& X_SC, std::vector<double>& each) {
  std::vector<Eigen::Vector3d> origins;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const HandEyeView& view : views) {
    origins.push_back((view.X_TS * X_SC * view.X_CB).translation_mm);
    mean += origins.back() / static_cast<double>(views.size());
  }
  double sum2 = 0;
  each.clear();
  for (const Eigen::Vector3d& origin : origins) {
    each.push_back((origin - mean).norm());
    sum2 += each.back() * each.back();
  }
  return std::sqrt(sum2 / static_cast<double>(views.size()));
}

void settle_turns(std::vector<HandEyeView>& views, const Pattern& pattern) {
  constexpr int kRounds = 5;
  for (std::size_t i = 1; i < views.size(); ++i) settle(views, i, i, pattern);
  // The first few were settled by few; now all are there.
  bool moved = true;
  for (int round = 0; moved && round < kRounds; ++round) {
    moved = false;
    for (std::size_t i = 1; i < views.size(); ++i) moved = settle(views, i, views.size(), pattern) || moved;
  }
}

Result<HandEyeFit> hand_eye_closed_form(const std::vector<HandEyeView>& views) {
  if (views.size() < 3)
    return fail("too few views: the board and the marker's pose are known together in " +
                std::to_string(views.size()) + "; three or more are accepted");
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero(), axes = Eigen::Matrix3d::Zero();
  double widest = 0;
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      const Motion m = motion(views[i], views[j]);
      const Eigen::Vector3d alpha = rotation_vector(m.A.rotation),
                            beta = rotation_vector(m.B_camera.rotation);
      cross += beta * alpha.transpose();
      axes += alpha * alpha.transpose();
      widest = std::max(widest, alpha.norm());
    }
  const double degrees = widest * 180 / std::numbers::pi;
  if (widest < 0.15)
    return fail(
        json::format("the scope turned by %.1f degrees at most between views, which leaves its hand-eye pose "
                     "open; turn it by 20 "
                     "degrees or more",
                     degrees));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(axes);
  if (spread.eigenvalues()[1] < 1e-3 * spread.eigenvalues()[2])
    return fail(
        "the scope turned about one axis only, which leaves its place along that axis open; turn it about "
        "another one too");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squared(cross.transpose() * cross);
  HandEyeFit fit;
  fit.X_SC.rotation = nearest_rotation(squared.operatorInverseSqrt() * cross.transpose()).rotation;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      const Motion m = motion(views[i], views[j]);
      const Eigen::Matrix3d left = m.A.rotation - Eigen::Matrix3d::Identity();
      normal += left.transpose() * left;
      right += left.transpose() * (fit.X_SC.rotation * m.B_camera.translation_mm - m.A.translation_mm);
    }
  fit.X_SC.translation_mm = normal.ldlt().solve(right);
  fit.scatter_mm = scatter_mm(views, fit.X_SC, fit.scatters_mm);
  fit.X_TB = views.front().X_TS * fit.X_SC * views.front().X_CB;
  for (const HandEyeView& view : views) fit.X_CB.push_back(view.X_CB);
  return fit;
}

}  // namespace orcart
