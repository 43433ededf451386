// Bundle adjustment over lens, board poses, hand-eye and board place; the marker's poses are measurements
// with noise.
#include <cmath>

#include <ceres/ceres.h>
#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "tools/calibration/board_pose.hpp"
#include "tools/calibration/hand_eye.hpp"

namespace orcart {
namespace {

using Block = std::array<double, 6>;

template <class A, class D>
Block block_of(const Pose<A, D>& X) {
  const Eigen::AngleAxisd turn(X.rotation);
  const Eigen::Vector3d r = turn.angle() * turn.axis(), &t = X.translation_mm;
  return {r.x(), r.y(), r.z(), t.x(), t.y(), t.z()};
}

template <class A, class D>
Pose<A, D> pose_of(const Block& b) {
  const Eigen::Vector3d r(b[0], b[1], b[2]);
  const double angle = r.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(r / angle) : Eigen::Vector3d::UnitX();
  return {.rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix(),
          .translation_mm = {b[3], b[4], b[5]}};
}

struct PixelCost {
  LensModel model;
  Eigen::Vector2d pixel;
  Eigen::Vector3d place;
  double sigma_px;
  template <class Number>
  bool operator()(const Number* intrinsics, const Number* X_CB, Number* residual) const {
    Number p[3], seen[2];
    lens_cost::transform(X_CB, place.data(), p);
    if (!lens_cost::project(model, intrinsics, p, seen)) return false;
    residual[0] = (seen[0] - pixel.x()) / sigma_px;
    residual[1] = (seen[1] - pixel.y()) / sigma_px;
    return true;
  }
};

/// The measured marker pose against the one that board, camera and hand-eye imply: X_TS = X_TB X_BC X_CS.
struct MarkerCost {
  Block measured;
  Eigen::Matrix<double, 6, 6> whitening;  ///< of turn and shift in the tracker's axes
  template <class Number>
  bool operator()(const Number* X_CB, const Number* X_SC, const Number* X_TB, Number* residual) const {
    Number tb[4], cb[4], sc[4], bc[4], cs[4], tc[4], ts[4], st[4], off[4], a[3], b[3], error[6];
    ceres::AngleAxisToQuaternion(X_TB, tb);
    ceres::AngleAxisToQuaternion(X_CB, cb);
    ceres::AngleAxisToQuaternion(X_SC, sc);
    conjugate(cb, bc);
    conjugate(sc, cs);
    ceres::QuaternionProduct(tb, bc, tc);
    ceres::QuaternionProduct(tc, cs, ts);
    // The marker's origin: -R_CS t_SC in the camera, then on through board and tracker.
    ceres::QuaternionRotatePoint(cs, X_SC + 3, a);
    for (int i = 0; i < 3; ++i) a[i] = -a[i] - X_CB[3 + i];
    ceres::QuaternionRotatePoint(bc, a, b);
    ceres::QuaternionRotatePoint(tb, b, error + 3);
    const Number given[3] = {Number(measured[0]), Number(measured[1]), Number(measured[2])};
    Number gq[4];
    ceres::AngleAxisToQuaternion(given, gq);
    conjugate(gq, st);
    ceres::QuaternionProduct(ts, st, off);
    ceres::QuaternionToAngleAxis(off, error);
    for (int i = 0; i < 3; ++i) error[3 + i] += X_TB[3 + i] - measured[static_cast<std::size_t>(3 + i)];
    for (int i = 0; i < 6; ++i) {
      residual[i] = Number(0);
      for (int j = 0; j <= i; ++j) residual[i] += whitening(i, j) * error[j];
    }
    return true;
  }
  template <class Number>
  static void conjugate(const Number* q, Number* result) {
    result[0] = q[0];
    for (int i = 1; i < 4; ++i) result[i] = -q[i];
  }
};

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

Result<HandEyeFit> refine_hand_eye(const std::vector<HandEyeView>& views, const Lens& lens,
                                   const RefineTask& task) {
  auto fit = hand_eye_closed_form(views);
  if (!fit) return fit;
  fit->lens = lens;
  const double sigma_px = std::sqrt(task.corners_alike) * std::max(0.05, rms_px(views, *fit) / 1.41);
  Intrinsics intrinsics = intrinsics_of(lens);
  Block hand_eye = block_of(fit->X_SC), board = block_of(fit->X_TB);
  std::vector<Block> cameras;
  for (const HandEyeView& view : views) cameras.push_back(block_of(view.X_CB));
  ceres::Problem problem;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const BoardCorner& c : views[v].board.corners)
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PixelCost, 2, kIntrinsics, 6>(
                                   new PixelCost{lens.model, c.pixel_px, c.board_mm, sigma_px}),
                               nullptr, intrinsics.data(), cameras[v].data());
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MarkerCost, 6, 6, 6, 6>(
                                 new MarkerCost{block_of(views[v].X_TS), whitening(views[v], task.noise)}),
                             new ceres::HuberLoss(5), cameras[v].data(), hand_eye.data(), board.data());
  }
  // Coefficients that the passport holds at zero stay there.
  std::vector<int> fixed;
  for (int i = 0; i < kIntrinsics; ++i)
    if (intrinsics[static_cast<std::size_t>(i)] == 0) fixed.push_back(i);
  if (lens.model != LensModel::poly4 && fixed.empty()) fixed = {9, 10};
  if (task.role == LensRole::held) {
    problem.SetParameterBlockConstant(intrinsics.data());
  } else if (!fixed.empty()) {
    problem.SetManifold(intrinsics.data(), new ceres::SubsetManifold(kIntrinsics, fixed));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 60;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return fail("the joint refinement of lens and hand-eye does not settle");
  fit->X_SC = pose_of<S, C>(hand_eye);
  fit->X_TB = pose_of<T, B>(board);
  fit->lens = lens_of(lens.model, intrinsics);
  std::vector<HandEyeView> refined = views;
  for (std::size_t v = 0; v < views.size(); ++v) fit->X_CB[v] = refined[v].X_CB = pose_of<C, B>(cameras[v]);
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
