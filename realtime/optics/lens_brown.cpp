// Brown's model (1966) with OpenCV's order of coefficients: radial to the sixth power, and decentring.
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "realtime/optics/bracketed_root.hpp"
#include "realtime/optics/lens_models.hpp"

namespace orcart::brown {
namespace {

struct DistortedPoint {
  Eigen::Vector2d at;
  Eigen::Matrix2d jacobian;
};

/// Normalised coordinates (x/z, y/z) to distorted ones, and how they move.
DistortedPoint distort(const Lens& lens, const Eigen::Vector2d& n) {
  const auto [k1, k2, p1, p2, k3] = lens.coefficients;
  const double x = n.x(), y = n.y(), r2 = n.squaredNorm();
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = k1 + r2 * (2 * k2 + r2 * 3 * k3);  // d radial / d r2
  DistortedPoint d;
  d.at = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  const double cross = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y;
  d.jacobian << radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x, cross, cross,
      radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return d;
}

/// The undistorted radius whose radial distortion gives `distorted`, within the lens.
double undistorted_radius(const Lens& lens, double distorted) {
  const auto [k1, k2, p1, p2, k3] = lens.coefficients;
  const double limit = std::tan(std::fmin(lens.max_angle_rad, 1.57));
  const auto radial = [k1 = k1, k2 = k2, k3 = k3](double r) {
    const double r2 = r * r;
    return ValueAndSlope{.value = r * (1 + r2 * (k1 + r2 * (k2 + r2 * k3))),
                         .slope = 1 + r2 * (3 * k1 + r2 * (5 * k2 + r2 * 7 * k3))};
  };
  return bracketed_root(radial, 0, limit, distorted);
}

/// The map is one-to-one on a disc (which is convex) where the symmetric part of its Jacobian is positive
/// definite; Brown's Jacobian is symmetric. Without decentring this is exactly "the radius grows".
bool one_to_one_at(const Lens& lens, double radius) {
  constexpr int kDirections = 32;
  for (int i = 0; i < kDirections; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / kDirections;
    const Eigen::Matrix2d j =
        distort(lens, radius * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth))).jacobian;
    if (!(j.trace() > 0 && j.determinant() > 0)) return false;
  }
  return true;
}

}  // namespace

Eigen::Vector2d project(const Lens& lens, const Eigen::Vector3d& p_C_mm) {
  const Eigen::Vector2d d = distort(lens, p_C_mm.head<2>() / p_C_mm.z()).at;
  return {lens.fx_px * d.x() + lens.cx_px, lens.fy_px * d.y() + lens.cy_px};
}

std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d target((pixel.x() - lens.cx_px) / lens.fx_px, (pixel.y() - lens.cy_px) / lens.fy_px);
  const double distorted = target.norm();
  Eigen::Vector2d n = target;
  if (distorted > 0) n *= undistorted_radius(lens, distorted) / distorted;
  for (int i = 0; i < 20; ++i) {  // decentring is small: two or three steps are the rule
    const DistortedPoint d = distort(lens, n);
    const Eigen::Vector2d error = d.at - target;
    if (error.norm() * lens.fx_px < 1e-11) break;
    n -= d.jacobian.inverse() * error;
  }
  const double left_px = (distort(lens, n).at - target).norm() * lens.fx_px;
  if (!(left_px < 1e-9)) return std::nullopt;
  return Eigen::Vector3d(n.x(), n.y(), 1);
}

double largest_monotone_angle_rad(const Lens& lens, double limit_rad) {
  constexpr int kSteps = 2000;
  const double limit = std::fmin(limit_rad, 0.5 * std::numbers::pi - 1e-3);
  for (int i = 1; i <= kSteps; ++i)
    if (!one_to_one_at(lens, std::tan(limit * i / kSteps))) return limit * (i - 1) / kSteps;
  return limit;
}

}  // namespace orcart::brown
