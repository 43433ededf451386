// The lens is fitted again to points that the same pixels see in fluid; C moves to where they seem to come
// from.
#include "tools/calibration/medium.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <ceres/ceres.h>

#include "tools/calibration/lens_cost.hpp"
#include "tools/calibration/mask_finder.hpp"

namespace orcart {
namespace {

constexpr std::array<double, 6> kDepths_mm{5, 10, 20, 30, 45, 60};
constexpr double kReported_mm = 20;
constexpr int kGrid = 24;

std::vector<Eigen::Vector2d> pixels_of(const ScopeModel& scope) {
  std::vector<Eigen::Vector2d> pixels;
  const double aspect = scope.lens.fy_px / scope.lens.fx_px;
  for (int j = 0; j <= kGrid; ++j)
    for (int i = 0; i <= kGrid; ++i) {
      const double x = 2.0 * i / kGrid - 1, y = 2.0 * j / kGrid - 1;
      const Eigen::Vector2d pixel(scope.mask.cx_px + x * scope.mask.radius_px,
                                  scope.mask.cy_px + y * scope.mask.radius_px * aspect);
      if (x * x + y * y <= 1 && pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= scope.width_px - 1 &&
          pixel.y() <= scope.height_px - 1)
        pixels.push_back(pixel);
    }
  return pixels;
}

struct FluidCost {
  LensModel model;
  Eigen::Vector2d pixel;
  Eigen::Vector3d seen;  ///< in the new C
  template <class T>
  bool operator()(const T* intrinsics, T* residual) const {
    const T p[3] = {T(seen.x()), T(seen.y()), T(seen.z())};
    T px[2];
    if (!lens_cost::project(model, intrinsics, p, px)) return false;
    residual[0] = px[0] - pixel.x();
    residual[1] = px[1] - pixel.y();
    return true;
  }
};

/// Focal lengths and radial coefficients move; centres and tangential ones stay.
std::vector<int> held(LensModel model) {
  switch (model) {
    case LensModel::brown:
      return {2, 3, 6, 7, 9, 10};
    case LensModel::fisheye:
      return {2, 3, 8, 9, 10};
    case LensModel::poly4:
      break;
  }
  return {2, 3, 7, 8, 9, 10};
}

Result<Lens> fitted(const ScopeModel& air, double index, double back_mm) {
  ceres::Problem problem;
  Intrinsics intrinsics = intrinsics_of(air.lens);
  intrinsics[0] *= index, intrinsics[1] *= index;
  const Eigen::Vector3d back(0, 0, back_mm);
  for (const Eigen::Vector2d& pixel : pixels_of(air))
    for (const double depth : kDepths_mm)
      if (const auto seen = seen_in_fluid(air, pixel, index, depth))
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<FluidCost, 2, kIntrinsics>(
                                     new FluidCost{air.lens.model, pixel, *seen + back}),
                                 nullptr, intrinsics.data());
  if (problem.NumResidualBlocks() < 50)
    return fail(
        "the lens sees next to nothing inside its mask's circle; a passport that fits its scope is accepted");
  problem.SetManifold(intrinsics.data(), new ceres::SubsetManifold(kIntrinsics, held(air.lens.model)));
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return fail("no lens explains what the pixels see in the fluid");
  return lens_of(air.lens.model, intrinsics);
}

/// How far the converted lens is from what the pixels see if window and index were so.
struct Left {
  double rms_px = 0, worst_px = 0, rms_mm = 0;
};
Left left_over(const MediumConversion& fluid, const ScopeModel& air, double index, double window_off_mm) {
  ScopeModel truth = air;
  truth.X_CE.translation_mm.z() += window_off_mm;
  const Eigen::Vector3d back(0, 0, fluid.viewpoint_mm);
  Left left;
  std::size_t count = 0, near = 0;
  for (const Eigen::Vector2d& pixel : pixels_of(air))
    for (const double depth : kDepths_mm) {
      const auto seen = seen_in_fluid(truth, pixel, index, depth);
      const auto again = seen ? project(fluid.scope.lens, *seen + back) : std::nullopt;
      const auto direction = direction_of(fluid.scope.lens, pixel);
      if (!again || !direction) continue;
      const double off_px = (*again - pixel).norm();
      left.rms_px += off_px * off_px, ++count;
      left.worst_px = std::max(left.worst_px, off_px);
      if (depth != kReported_mm) continue;
      left.rms_mm += (*seen + back).cross(*direction).squaredNorm(), ++near;
    }
  left.rms_px = count > 0 ? std::sqrt(left.rms_px / static_cast<double>(count)) : 0;
  left.rms_mm = near > 0 ? std::sqrt(left.rms_mm / static_cast<double>(near)) : 0;
  return left;
}

}  // namespace

double refractive_index(Medium medium) {
  switch (medium) {
    case Medium::water:
      return 1.333;
    case Medium::saline:
      return 1.335;
    case Medium::air:
      break;
  }
  return 1;
}

std::optional<Eigen::Vector3d> seen_in_fluid(const ScopeModel& air, const Eigen::Vector2d& pixel,
                                             double index, double depth_mm) {
  const auto direction = direction_of(air.lens, pixel);
  if (!direction || direction->z() < 0.05) return std::nullopt;
  const double window_mm = air.X_CE.translation_mm.z();
  const Eigen::Vector2d side = direction->head<2>() / index;
  const double ahead = std::sqrt(1 - side.squaredNorm());
  const Eigen::Vector2d at_window = direction->head<2>() * (window_mm / direction->z());
  const Eigen::Vector2d seen = at_window + side * (depth_mm / ahead);
  return Eigen::Vector3d(seen.x(), seen.y(), window_mm + depth_mm);
}

Result<MediumConversion> to_fluid(const ScopeModel& air, Medium fluid, const MediumDoubt& doubt) {
  if (air.medium != Medium::air)
    return fail("the passport was not made in air; only one that was is converted");
  if (fluid == Medium::air) return fail("air to air changes nothing; water or saline are accepted");
  const double window_mm = air.X_CE.translation_mm.z();
  if (!(window_mm > 0) || window_mm > 50)
    return fail(
        "the window's place before the optical centre is not known (X_CE); run orcart calibrate tip, or "
        "state --window-mm");
  const double index = refractive_index(fluid);
  MediumConversion result{.scope = air, .viewpoint_mm = (index - 1) * window_mm};
  auto lens = fitted(air, index, result.viewpoint_mm);
  if (!lens) return tl::unexpected(lens.error());
  ScopeModel& scope = result.scope;
  scope.lens = *lens;
  scope.medium = fluid;
  Pose<C, C> back;
  back.translation_mm.z() = -result.viewpoint_mm;
  scope.X_SC = air.X_SC * back;
  scope.X_CE = back.inverse() * air.X_CE;
  // Its place along the axis grows by the index, and its error with it.
  const Eigen::Vector3d grown(1, 1, index);
  if (air.window_covariance)
    scope.window_covariance = grown.asDiagonal() * *air.window_covariance * grown.asDiagonal();
  if (!monotone_to_edge(scope.lens, scope.mask, {scope.width_px, scope.height_px}))
    return fail("the lens in fluid folds the picture inside its mask's circle; calibrate in the fluid");
  scope.cone_half_angle_rad = cone_half_angle_rad(scope.lens, scope.mask, {scope.width_px, scope.height_px});
  const Left alone = left_over(result, air, index, 0);
  result.viewpoint_rms_px = alone.rms_px, result.viewpoint_worst_px = alone.worst_px;
  // What doubt adds to the rest that one viewpoint leaves anyway.
  const Left window = left_over(result, air, index, doubt.window_mm),
             turned = left_over(result, air, index + doubt.index, 0);
  const auto together = [](double a, double b, double c) {
    return std::sqrt(std::max(0.0, b * b - a * a) + std::max(0.0, c * c - a * a) + a * a);
  };
  result.added_px = together(alone.rms_px, window.rms_px, turned.rms_px);
  result.added_mm = together(alone.rms_mm, window.rms_mm, turned.rms_mm);
  scope.residual_px = std::hypot(air.residual_px, result.added_px);
  if (air.residual_mm > 0) scope.residual_mm = std::hypot(air.residual_mm, result.added_mm);
  // The lens was fitted to another one, not to corners, so its covariance is not known; C moves along.
  scope.lens_covariance.reset();
  if (air.hand_eye_covariance)
    scope.hand_eye_covariance = covariance_seen_from(back, *air.hand_eye_covariance);
  return result;
}

}  // namespace orcart
