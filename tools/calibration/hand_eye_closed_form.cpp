// The hand-eye equation A X = X B over all pairs of views.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

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

Pose<C, B> half_turned(const Pose<C, B>& X_CB, const Eigen::Vector3d& far_corner_mm) {
  Pose<B, B> turn;
  turn.rotation = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turn.translation_mm = far_corner_mm;
  return X_CB * turn;
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

void settle_half_turns(std::vector<HandEyeView>& views, const Pattern& pattern) {
  const Eigen::Vector3d far_corner =
      pattern.place_mm({pattern.corner_columns() - 1, pattern.corner_rows() - 1});
  for (std::size_t i = 1; i < views.size(); ++i) {
    if (views[i].board.anchor != Anchor::half_turn) continue;
    const auto disagreement = [&](const Pose<C, B>& X_CB) {
      HandEyeView tried = views[i];
      tried.X_CB = X_CB;
      double sum = 0;
      for (std::size_t j = 0; j < i; ++j) {
        const Motion m = motion(views[j], tried);
        sum += std::abs(rotation_vector(m.A.rotation).norm() - rotation_vector(m.B_camera.rotation).norm());
      }
      return sum;
    };
    const Pose<C, B> other = half_turned(views[i].X_CB, far_corner);
    if (disagreement(other) >= disagreement(views[i].X_CB)) continue;
    views[i].X_CB = other;
    for (BoardCorner& c : views[i].board.corners) {
      c.lattice = Eigen::Vector2i(pattern.corner_columns() - 1, pattern.corner_rows() - 1) - c.lattice;
      c.board_mm = far_corner - c.board_mm;
    }
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
