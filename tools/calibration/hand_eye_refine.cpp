// Bundle adjustment over lens, board poses, hand-eye and board place.
#include <cmath>

#include <Eigen/Cholesky>

#include "tools/calibration/board_pose.hpp"
#include "tools/calibration/hand_eye_cost.hpp"

namespace orcart {
namespace {

double rms_px(const std::vector<HandEyeView>& views, const HandEyeFit& fit) {
  double sum2 = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < views.size(); ++v)
    for (const BoardCorner& c : views[v].board.corners)
      if (const auto seen = project(fit.lens, (fit.X_CB[v] * Point<B>{c.board_mm}).mm))
        sum2 += (*seen - c.pixel_px).squaredNorm(), ++count;
  return count > 0 ? std::sqrt(sum2 / static_cast<double>(count)) : 0;
}

Eigen::Matrix<double, 6, 6> whitening(const HandEyeView& view, const TrackerNoise& noise) {
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> root(pose_covariance(noise, view.X_TS.translation_mm));
  return root.matrixL().solve(Eigen::Matrix<double, 6, 6>::Identity());
}

}  // namespace

hand_eye::JointProblem::JointProblem(const std::vector<HandEyeView>& views, const HandEyeFit& start,
                                     const RefineTask& task)
    : intrinsics(intrinsics_of(start.lens)), hand_eye(block_of(start.X_SC)), board(block_of(start.X_TB)) {
  for (const Pose<C, B>& X_CB : start.X_CB) cameras.push_back(block_of(X_CB));
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const BoardCorner& c : views[v].board.corners)
      corners.push_back(problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<PixelCost, 2, kIntrinsics, 6>(
              new PixelCost{start.lens.model, c.pixel_px, c.board_mm, start.corner_sigma_px}),
          nullptr, intrinsics.data(), cameras[v].data()));
    markers.push_back(
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MarkerCost, 6, 6, 6, 6>(new MarkerCost{
                                     block_of(views[v].X_TS), whitening(views[v], task.noise)}),
                                 new ceres::HuberLoss(5), cameras[v].data(), hand_eye.data(), board.data()));
  }
  // Coefficients that the passport holds at zero stay there.
  std::vector<int> fixed;
  for (int i = 0; i < kIntrinsics; ++i)
    if (intrinsics[static_cast<std::size_t>(i)] == 0) fixed.push_back(i);
  if (start.lens.model != LensModel::poly4 && fixed.empty()) fixed = {9, 10};
  if (task.role == LensRole::held) {
    problem.SetParameterBlockConstant(intrinsics.data());
  } else if (!fixed.empty()) {
    problem.SetManifold(intrinsics.data(), new ceres::SubsetManifold(kIntrinsics, fixed));
  }
}

Result<HandEyeFit> refine_hand_eye(const std::vector<HandEyeView>& views, const Lens& lens,
                                   const RefineTask& task) {
  auto fit = hand_eye_closed_form(views);
  if (!fit) return fit;
  fit->lens = lens;
  fit->corner_sigma_px = std::sqrt(task.corners_alike) * std::max(0.05, rms_px(views, *fit) / 1.41);
  hand_eye::JointProblem joint(views, *fit, task);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 60;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &joint.problem, &summary);
  if (!summary.IsSolutionUsable()) return fail("the joint refinement of lens and hand-eye does not settle");
  fit->X_SC = hand_eye::pose_of<S, C>(joint.hand_eye);
  fit->X_TB = hand_eye::pose_of<T, B>(joint.board);
  fit->lens = lens_of(lens.model, joint.intrinsics);
  std::vector<HandEyeView> refined = views;
  for (std::size_t v = 0; v < views.size(); ++v)
    fit->X_CB[v] = refined[v].X_CB = hand_eye::pose_of<C, B>(joint.cameras[v]);
  // The scatter counts each view as the camera alone sees the board, not as the tracker has pulled it.
  fit->scatter_mm = scatter_mm(views, fit->X_SC, fit->scatters_mm);
  fit->rms_px = rms_px(views, *fit);
  return fit;
}

Result<double> leave_one_out_mm(const std::vector<HandEyeView>& views, const Lens& lens,
                                const RefineTask& task, std::vector<double>* each) {
  double sum2 = 0;
  for (std::size_t left = 0; left < views.size(); ++left) {
    std::vector<HandEyeView> others = views;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left));
    const auto fit = refine_hand_eye(others, lens, task);
    if (!fit) return tl::unexpected(fit.error());
    Pose<C, B> X_CB = views[left].X_CB;
    if (task.role == LensRole::refined) {
      const auto through = board_pose(views[left].board, fit->lens);
      if (!through) return tl::unexpected(through.error());
      X_CB = *through;
    }
    const Eigen::Vector3d seen = (views[left].X_TS * fit->X_SC * X_CB).translation_mm;
    const double off2 = (seen - fit->X_TB.translation_mm).squaredNorm();
    if (each != nullptr) each->push_back(std::sqrt(off2));
    sum2 += off2;
  }
  return std::sqrt(sum2 / static_cast<double>(views.size()));
}

}  // namespace orcart
