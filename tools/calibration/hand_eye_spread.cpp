// The normal equations at the solution, inverted; the degrees of freedom by the hat matrix.
#include <cmath>

#include <Eigen/Cholesky>

#include "tools/calibration/hand_eye_cost.hpp"

namespace orcart {
namespace {

using hand_eye::JointProblem;

struct Linearised {
  Eigen::MatrixXd jacobian;  ///< markers' rows first; columns: hand-eye, board, cameras, lens where it moves
  Eigen::VectorXd residuals;
};

std::optional<Linearised> linearised(JointProblem& joint, LensRole role) {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = joint.markers;
  options.residual_blocks.insert(options.residual_blocks.end(), joint.corners.begin(), joint.corners.end());
  options.parameter_blocks = {joint.hand_eye.data(), joint.board.data()};
  for (auto& camera : joint.cameras) options.parameter_blocks.push_back(camera.data());
  if (role == LensRole::refined) options.parameter_blocks.push_back(joint.intrinsics.data());
  std::vector<double> residuals;
  ceres::CRSMatrix rows;
  if (!joint.problem.Evaluate(options, nullptr, &residuals, nullptr, &rows)) return std::nullopt;
  Linearised at{.jacobian = Eigen::MatrixXd::Zero(rows.num_rows, rows.num_cols),
                .residuals = Eigen::Map<Eigen::VectorXd>(residuals.data(), rows.num_rows)};
  for (int r = 0; r < rows.num_rows; ++r)
    for (int k = rows.rows[static_cast<std::size_t>(r)]; k < rows.rows[static_cast<std::size_t>(r) + 1]; ++k)
      at.jacobian(r, rows.cols[static_cast<std::size_t>(k)]) = rows.values[static_cast<std::size_t>(k)];
  return at;
}

/// Nothing where a combination of the unknowns is left open. Columns are brought to one size first.
std::optional<Eigen::MatrixXd> inverse_of_normal(const Eigen::MatrixXd& jacobian) {
  const Eigen::VectorXd size = jacobian.colwise().norm();
  if (size.minCoeff() <= 0) return std::nullopt;
  const Eigen::MatrixXd level = jacobian * size.cwiseInverse().asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> normal(level.transpose() * level);
  constexpr double kOpen = 1e-13;
  if (normal.info() != Eigen::Success || normal.vectorD().minCoeff() < kOpen) return std::nullopt;
  const Eigen::MatrixXd inverse = normal.solve(Eigen::MatrixXd::Identity(jacobian.cols(), jacobian.cols()));
  return size.cwiseInverse().asDiagonal() * inverse * size.cwiseInverse().asDiagonal();
}

/// From the block's numbers (rotation vector, place) to a twist in C: the right Jacobian of SO(3) (Chirikjian
/// 2011, equation 10.86) and the place in C's axes.
Eigen::Matrix<double, 6, 6> twist_by_numbers(const hand_eye::Block& block) {
  const Eigen::Vector3d turn(block[0], block[1], block[2]);
  const double angle = turn.norm();
  const Eigen::Matrix3d cross = cross_matrix(turn);
  Eigen::Matrix3d right = Eigen::Matrix3d::Identity() - cross / 2;
  if (angle > 1e-4)
    right = Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / (angle * angle) * cross +
            (angle - std::sin(angle)) / (angle * angle * angle) * cross * cross;
  Eigen::Matrix<double, 6, 6> twist = Eigen::Matrix<double, 6, 6>::Zero();
  twist.topRightCorner<3, 3>() = hand_eye::pose_of<S, C>(block).rotation.transpose();
  twist.bottomLeftCorner<3, 3>() = right;
  return twist;
}

LensCovariance lens_block(JointProblem& joint, LensModel model, const Eigen::MatrixXd& free) {
  const int all = kIntrinsics;
  std::vector<double> plus(static_cast<std::size_t>(all) * static_cast<std::size_t>(free.rows()));
  joint.problem.GetManifold(joint.intrinsics.data())->PlusJacobian(joint.intrinsics.data(), plus.data());
  const Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> spread(
      plus.data(), all, free.rows());
  return covariance_in_lens_units(model, spread * free * spread.transpose());
}

}  // namespace

std::optional<HandEyeSpread> hand_eye_spread(const std::vector<HandEyeView>& views, const HandEyeFit& fit,
                                             const RefineTask& task) {
  JointProblem joint(views, fit, task);
  const auto at = linearised(joint, task.role);
  if (!at) return std::nullopt;
  const auto covariance = inverse_of_normal(at->jacobian);
  if (!covariance) return std::nullopt;
  const auto rows = static_cast<Eigen::Index>(6 * views.size());
  const Eigen::MatrixXd markers = at->jacobian.topRows(rows);
  const double freedom = static_cast<double>(rows) - (markers * *covariance).cwiseProduct(markers).sum();
  if (freedom < 3) return std::nullopt;
  HandEyeSpread spread{.misfit = at->residuals.head(rows).squaredNorm() / freedom, .freedom = freedom};
  const Eigen::Matrix<double, 6, 6> twist = twist_by_numbers(joint.hand_eye);
  spread.hand_eye =
      spread.misfit * freedom / (freedom - 2) * twist * covariance->topLeftCorner<6, 6>() * twist.transpose();
  if (task.role == LensRole::refined) {
    const Eigen::Index free = covariance->rows() - 12 - rows;
    spread.lens = lens_block(joint, fit.lens.model, covariance->bottomRightCorner(free, free));
  }
  return spread;
}

}  // namespace orcart
