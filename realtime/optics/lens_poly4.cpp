// Haneishi's model (1995), as the paper uses it: a polynomial from the distorted radius to the corrected one.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "realtime/optics/bracketed_root.hpp"
#include "realtime/optics/lens_models.hpp"

namespace orcart::poly4 {
namespace {

/// Nobody's picture is wider; a search for a fold ends here.
constexpr double kWidestRadius_px = 1e5;

/// Corrected radius of a distorted one, pixels.
ValueAndSlope corrected(const Lens& lens, double r) {
  const auto [a2, a3, a4, unused3, unused4] = lens.coefficients;
  return {.value = r * (1 + r * (a2 + r * (a3 + r * a4))),
          .slope = 1 + r * (2 * a2 + r * (3 * a3 + r * 4 * a4))};
}

/// Where the slope itself turns, in rising order: between two of them the slope only rises or only falls.
std::array<double, 3> turns_of_slope(const Lens& lens) {
  const auto [a2, a3, a4, unused3, unused4] = lens.coefficients;
  const double a = 12 * a4, b = 6 * a3, c = 2 * a2;  // a r^2 + b r + c = 0
  std::array<double, 3> turns{kWidestRadius_px, kWidestRadius_px, kWidestRadius_px};
  const double discriminant = b * b - 4 * a * c;
  if (discriminant >= 0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    if (a != 0 && q / a > 0) turns[0] = q / a;
    if (q != 0 && c / q > 0) turns[1] = c / q;
  }
  for (double& turn : turns) turn = std::min(turn, kWidestRadius_px);
  std::sort(turns.begin(), turns.end());
  return turns;
}

/// The first distorted radius at which the corrected one stops growing.
double fold_radius_px(const Lens& lens) {
  double low = 0;
  for (double high : turns_of_slope(lens)) {
    if (corrected(lens, high).slope > 0) {
      low = high;
      continue;
    }
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (corrected(lens, middle).slope > 0 ? low : high) = middle;
    }
    return low;
  }
  return kWidestRadius_px;
}

/// A pixel as a vector from the distortion centre, in pixels made square.
Eigen::Vector2d square_from_centre(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d d = pixel - lens.distortion_centre_px;
  return {d.x(), d.y() * lens.fx_px / lens.fy_px};
}

Eigen::Vector2d pixel_of_square(const Lens& lens, const Eigen::Vector2d& square) {
  return lens.distortion_centre_px + Eigen::Vector2d(square.x(), square.y() * lens.fy_px / lens.fx_px);
}

}  // namespace

Eigen::Vector2d project(const Lens& lens, const Eigen::Vector3d& p_C_mm) {
  const Eigen::Vector2d pinhole(lens.fx_px * p_C_mm.x() / p_C_mm.z() + lens.cx_px,
                                lens.fy_px * p_C_mm.y() / p_C_mm.z() + lens.cy_px);
  const Eigen::Vector2d square = square_from_centre(lens, pinhole);
  const double radius = square.norm();
  if (radius == 0) return pinhole;
  const auto polynomial = [&lens](double r) { return corrected(lens, r); };
  const double distorted = bracketed_root(polynomial, 0, fold_radius_px(lens), radius);
  return pixel_of_square(lens, square * (distorted / radius));
}

std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d square = square_from_centre(lens, pixel);
  const double radius = square.norm();
  if (!(radius <= fold_radius_px(lens))) return std::nullopt;
  const double factor = radius > 0 ? corrected(lens, radius).value / radius : 1;
  const Eigen::Vector2d pinhole = pixel_of_square(lens, square * factor);
  return Eigen::Vector3d((pinhole.x() - lens.cx_px) / lens.fx_px, (pinhole.y() - lens.cy_px) / lens.fy_px, 1);
}

/// The cone about the optical axis that stays inside the fold's circle about the distortion centre.
double largest_monotone_angle_rad(const Lens& lens, double limit_rad) {
  const double corrected_px = corrected(lens, fold_radius_px(lens)).value;
  const double offset_px = square_from_centre(lens, {lens.cx_px, lens.cy_px}).norm();
  const double angle = std::atan(std::max(0.0, corrected_px - offset_px) / lens.fx_px);
  return std::min({angle, limit_rad, 0.5 * std::numbers::pi - 1e-3});
}

}  // namespace orcart::poly4
