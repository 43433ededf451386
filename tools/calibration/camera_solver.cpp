// Several starts for the focal length, poses from homographies, then everything together; gross outliers are
// dropped once.
#include "tools/calibration/camera_solver.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>
#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

namespace orcart {
namespace {

using PoseBlock = std::array<double, 6>;

struct CornerCost {
  LensModel model;
  Eigen::Vector2d pixel;
  Eigen::Vector3d place;
  template <class T>
  bool operator()(const T* intrinsics, const T* pose, T* residual) const {
    T p[3], seen[2];
    lens_cost::transform(pose, place.data(), p);
    if (!lens_cost::project(model, intrinsics, p, seen)) return false;
    residual[0] = seen[0] - pixel.x();
    residual[1] = seen[1] - pixel.y();
    return true;
  }
};

/// The distance to the board's plane along the optical axis is known but for an offset common to all views:
/// it is the same whichever corner a view counts from.
struct DistanceCost {
  double distance_mm;
  template <class T>
  bool operator()(const T* pose, const T* offset, T* residual) const {
    constexpr double kStageSigma_mm = 0.05;
    const T z[3] = {T(0), T(0), T(1)};
    T normal[3];
    ceres::AngleAxisRotatePoint(pose, z, normal);
    const T along = normal[0] * pose[3] + normal[1] * pose[4] + normal[2] * pose[5];
    residual[0] = (along / normal[2] - offset[0] - distance_mm) / kStageSigma_mm;
    return true;
  }
};

struct State {
  Intrinsics intrinsics{};
  std::vector<PoseBlock> poses;
  double offset_mm = 0;
  double cost = 1e300;
};

/// Indices of the intrinsics that stay as they are.
std::vector<int> held(LensModel model, int coefficients) {
  switch (model) {
    case LensModel::brown:
      if (coefficients >= 5) return {9, 10};
      if (coefficients == 4) return {8, 9, 10};
      if (coefficients == 2) return {6, 7, 8, 9, 10};
      return {5, 6, 7, 8, 9, 10};
    case LensModel::fisheye:
      if (coefficients >= 4) return {8, 9, 10};
      return {6, 7, 8, 9, 10};
    case LensModel::poly4:
      break;
  }
  return {7, 8};
}

/// Few coefficients first, so that a poor start does not fold the picture.
std::vector<int> held_at_first(LensModel model) {
  if (model == LensModel::poly4) return {2, 3, 6, 7, 8, 9, 10};
  return {2, 3, 5, 6, 7, 8, 9, 10};
}

class Solver {
 public:
  Solver(const std::vector<BoardView>& views, const CameraTask& task) : views_(views), task_(task) {}

  State best_start() const {
    State best;
    const double width = views_.front().width_px;
    for (const double part : {0.35, 0.6, 1.0, 1.7}) {
      State state = start(part * width);
      if (state.poses.empty()) continue;
      solve(state, held_at_first(task_.model), 30, 3.0);
      if (state.cost < best.cost) best = std::move(state);
    }
    return best;
  }

  void solve(State& state, const std::vector<int>& fixed, int iterations, double huber_px) const {
    ceres::Problem problem;
    build(problem, state, fixed, huber_px);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = iterations;
    options.function_tolerance = 1e-11;
    options.parameter_tolerance = 1e-11;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    state.cost = summary.IsSolutionUsable() && std::isfinite(summary.final_cost) ? summary.final_cost : 1e300;
  }

  /// Fills deviations and covariance; false where the equations leave something open.
  bool spread(State& state, const std::vector<int>& fixed, CameraFit& fit) const {
    ceres::Problem problem;
    build(problem, state, fixed, 0);
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    ceres::Covariance covariance(options);
    const double* block = state.intrinsics.data();
    const std::vector<std::pair<const double*, const double*>> blocks{{block, block}};
    if (!covariance.Compute(blocks, &problem)) return false;
    Eigen::Matrix<double, kIntrinsics, kIntrinsics, Eigen::RowMajor> values;
    covariance.GetCovarianceBlock(block, block, values.data());
    const auto views = static_cast<double>(views_.size());
    const double known = task_.distances_mm.empty() ? 0 : views - 1;  // all but their common offset
    const double free = 2.0 * static_cast<double>(fit.corners) + known -
                        (kIntrinsics - static_cast<double>(fixed.size())) - 6.0 * views;
    values *= 2 * state.cost / std::max(1.0, free);
    for (int i = 0; i < kIntrinsics; ++i)
      fit.deviations[static_cast<std::size_t>(i)] = std::sqrt(std::max(0.0, values(i, i)));
    fit.covariance = covariance_in_lens_units(task_.model, values);
    return true;
  }

 private:
  State start(double focal_px) const {
    State state;
    state.intrinsics = {focal_px, focal_px, task_.centre_px.x(), task_.centre_px.y()};
    state.intrinsics[9] = task_.centre_px.x(), state.intrinsics[10] = task_.centre_px.y();
    const cv::Matx33d k(focal_px, 0, task_.centre_px.x(), 0, focal_px, task_.centre_px.y(), 0, 0, 1);
    for (const BoardView& view : views_) {
      std::vector<cv::Point3d> board;
      std::vector<cv::Point2d> pixels;
      for (const BoardCorner& c : view.corners) {
        board.emplace_back(c.board_mm.x(), c.board_mm.y(), 0);
        pixels.emplace_back(c.pixel_px.x(), c.pixel_px.y());
      }
      cv::Vec3d r, t;
      if (!cv::solvePnP(board, pixels, k, cv::noArray(), r, t)) return {};
      state.poses.push_back({r[0], r[1], r[2], t[0], t[1], t[2]});
    }
    return state;
  }

  void build(ceres::Problem& problem, State& state, const std::vector<int>& fixed, double huber_px) const {
    double* intrinsics = state.intrinsics.data();
    for (std::size_t v = 0; v < views_.size(); ++v) {
      for (const BoardCorner& c : views_[v].corners)
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CornerCost, 2, kIntrinsics, 6>(
                                     new CornerCost{task_.model, c.pixel_px, c.board_mm}),
                                 huber_px > 0 ? new ceres::HuberLoss(huber_px) : nullptr, intrinsics,
                                 state.poses[v].data());
      if (!task_.distances_mm.empty())
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<DistanceCost, 1, 6, 1>(new DistanceCost{task_.distances_mm[v]}),
            nullptr, state.poses[v].data(), &state.offset_mm);
    }
    problem.SetManifold(intrinsics, new ceres::SubsetManifold(kIntrinsics, fixed));
    problem.SetParameterLowerBound(intrinsics, 0, 10);
    problem.SetParameterLowerBound(intrinsics, 1, 10);
  }

  const std::vector<BoardView>& views_;
  const CameraTask& task_;
};

Pose<C, B> pose_of(const PoseBlock& block) {
  const Eigen::Vector3d turn(block[0], block[1], block[2]);
  const double angle = turn.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX();
  return {.rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix(),
          .translation_mm = {block[3], block[4], block[5]}};
}

Eigen::Vector2d residual_of(LensModel model, const State& state, std::size_t view,
                            const BoardCorner& corner) {
  Eigen::Vector2d residual(1e6, 1e6);
  CornerCost{model, corner.pixel_px, corner.board_mm}(state.intrinsics.data(), state.poses[view].data(),
                                                      residual.data());
  return residual;
}

/// Corners farther off than six robust standard deviations, and at least a pixel, are taken out. True where
/// any was.
bool drop_outliers(std::vector<BoardView>& views, const State& state, LensModel model,
                   std::vector<ViewFit>& fits) {
  std::vector<double> distances;
  for (std::size_t v = 0; v < views.size(); ++v)
    for (const BoardCorner& c : views[v].corners) distances.push_back(residual_of(model, state, v, c).norm());
  auto sorted = distances;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit = std::max(1.0, 6 * 0.85 * *middle);
  bool any = false;
  std::size_t next = 0;
  for (std::size_t v = 0; v < views.size(); ++v)
    fits[v].dropped +=
        std::erase_if(views[v].corners, [&](const BoardCorner&) { return distances[next++] > limit; });
  for (const ViewFit& fit : fits) any = any || fit.dropped > 0;
  return any;
}

void measure(const std::vector<BoardView>& views, const State& state, CameraFit& fit) {
  double px2 = 0, mm2 = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    ViewFit& view = fit.views[v];
    view.X_CB = pose_of(state.poses[v]);
    const auto count = static_cast<double>(views[v].corners.size());
    double sum2 = 0;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const BoardCorner& c : views[v].corners) {
      const double off2 = residual_of(fit.lens.model, state, v, c).squaredNorm();
      sum2 += off2;
      view.worst_px = std::max(view.worst_px, std::sqrt(off2));
      middle += c.board_mm / count;
    }
    view.rms_px = std::sqrt(sum2 / count);
    view.rms_mm = rms_on_board_mm(fit.lens, view.X_CB, views[v].corners);
    view.distance_mm = (view.X_CB * Point<B>{middle}).mm.norm();
    view.tilt_rad = std::acos(std::clamp(std::abs(view.X_CB.rotation(2, 2)), 0.0, 1.0));
    px2 += sum2;
    mm2 += count * view.rms_mm * view.rms_mm;
    fit.corners += views[v].corners.size();
  }
  fit.rms_px = std::sqrt(px2 / static_cast<double>(fit.corners));
  fit.rms_mm = std::sqrt(mm2 / static_cast<double>(fit.corners));
}

}  // namespace

Intrinsics intrinsics_of(const Lens& lens) {
  Intrinsics k{lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px};
  double scale = 1;
  for (std::size_t i = 0; i < 5; ++i) {
    if (lens.model == LensModel::poly4) scale *= kPolynomialScale_px;
    k[4 + i] = lens.coefficients[i] * scale;
  }
  k[9] = lens.distortion_centre_px.x(), k[10] = lens.distortion_centre_px.y();
  return k;
}

LensCovariance covariance_in_lens_units(LensModel model, const LensCovariance& of_intrinsics) {
  LensStep scale = LensStep::Ones();
  if (model == LensModel::poly4)
    for (int i = 0; i < 5; ++i) scale[4 + i] = std::pow(kPolynomialScale_px, -1 - i);
  return scale.asDiagonal() * of_intrinsics * scale.asDiagonal();
}

Lens lens_of(LensModel model, const Intrinsics& k) {
  Lens lens{.model = model, .fx_px = k[0], .fy_px = k[1], .cx_px = k[2], .cy_px = k[3]};
  double scale = 1;
  for (std::size_t i = 0; i < 5; ++i) {
    if (model == LensModel::poly4) scale *= kPolynomialScale_px;
    lens.coefficients[i] = k[4 + i] / scale;
  }
  if (model == LensModel::poly4) lens.distortion_centre_px = {k[9], k[10]};
  lens.max_angle_rad = largest_monotone_angle_rad(lens, 1.5);
  return lens;
}

double rms_on_board_mm(const Lens& lens, const Pose<C, B>& X_CB, const std::vector<BoardCorner>& corners) {
  const Pose<B, C> X_BC = X_CB.inverse();
  double sum2 = 0;
  int count = 0;
  for (const BoardCorner& c : corners) {
    const auto direction = direction_of(lens, c.pixel_px);
    if (!direction) continue;
    const Eigen::Vector3d along = X_BC.rotation * *direction;
    const Eigen::Vector3d hit = X_BC.translation_mm - along * (X_BC.translation_mm.z() / along.z());
    sum2 += (hit - c.board_mm).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum2 / count) : 0;
}

Result<CameraFit> solve_camera(std::vector<BoardView>& views, const CameraTask& task) {
  const Solver solver(views, task);
  State state = solver.best_start();
  if (state.poses.empty() || state.cost >= 1e299)
    return fail("no focal length explains the corners that were found");
  CameraFit fit;
  fit.views.resize(views.size());
  const auto fixed = held(task.model, task.coefficients);
  solver.solve(state, fixed, 100, 2.0);
  if (drop_outliers(views, state, task.model, fit.views)) solver.solve(state, fixed, 50, 2.0);
  solver.solve(state, fixed, 200, 0);
  if (state.cost >= 1e299) return fail("the refinement of the lens does not settle");
  fit.lens = lens_of(task.model, state.intrinsics);
  measure(views, state, fit);
  fit.determined = solver.spread(state, fixed, fit);
  return fit;
}

}  // namespace orcart
