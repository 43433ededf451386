// Kannala and Brandt's model (2006), as OpenCV's fisheye: an odd polynomial of the angle off the axis.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "realtime/optics/bracketed_root.hpp"
#include "realtime/optics/lens_models.hpp"

namespace orcart::fisheye {
namespace {

/// Distorted angle of an angle off the axis, radians.
ValueAndSlope distorted(const Lens& lens, double angle) {
  const auto [k1, k2, k3, k4, unused] = lens.coefficients;
  const double t = angle * angle;
  return {.value = angle * (1 + t * (k1 + t * (k2 + t * (k3 + t * k4)))),
          .slope = 1 + t * (3 * k1 + t * (5 * k2 + t * (7 * k3 + t * 9 * k4)))};
}

}  // namespace

Eigen::Vector2d project(const Lens& lens, const Eigen::Vector3d& p_C_mm) {
  const double off_axis = std::hypot(p_C_mm.x(), p_C_mm.y());
  if (off_axis == 0) return {lens.cx_px, lens.cy_px};
  const double scale = distorted(lens, std::atan2(off_axis, p_C_mm.z())).value / off_axis;
  return {lens.fx_px * scale * p_C_mm.x() + lens.cx_px, lens.fy_px * scale * p_C_mm.y() + lens.cy_px};
}

std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d n((pixel.x() - lens.cx_px) / lens.fx_px, (pixel.y() - lens.cy_px) / lens.fy_px);
  const double radius = n.norm();
  if (radius == 0) return Eigen::Vector3d::UnitZ();
  const auto polynomial = [&lens](double angle) { return distorted(lens, angle); };
  const double angle = bracketed_root(polynomial, 0, lens.max_angle_rad, radius);
  if (!(std::abs(distorted(lens, angle).value - radius) * lens.fx_px < 1e-9)) return std::nullopt;
  const Eigen::Vector2d side = n * (std::sin(angle) / radius);
  return Eigen::Vector3d(side.x(), side.y(), std::cos(angle));
}

double largest_monotone_angle_rad(const Lens& lens, double limit_rad) {
  constexpr int kSteps = 2000;
  const double limit = std::min(limit_rad, std::numbers::pi);
  for (int i = 1; i <= kSteps; ++i)
    if (!(distorted(lens, limit * i / kSteps).slope > 0)) return limit * (i - 1) / kSteps;
  return limit;
}

}  // namespace orcart::fisheye
