// Differences of projections, number by number; then the quadratic form.
#include "realtime/optics/lens_covariance.hpp"

#include <cmath>
#include <numbers>

namespace orcart {
namespace {

using PixelJacobian = Eigen::Matrix<double, 2, kLensNumbers>;

/// Of the pixel by the lens's numbers; nothing where the lens does not see the direction.
std::optional<PixelJacobian> pixel_jacobian(const Lens& lens, const LensCovariance& covariance,
                                            const Eigen::Vector3d& direction) noexcept {
  constexpr double kPart = 0.01;
  PixelJacobian jacobian = PixelJacobian::Zero();
  for (int i = 0; i < kLensNumbers; ++i) {
    const double deviation = std::sqrt(std::fmax(0.0, covariance(i, i)));
    if (deviation == 0) continue;
    const double half = kPart * deviation;
    LensStep step = LensStep::Zero();
    step[i] = half;
    const auto plus = project(stepped(lens, step), direction),
               minus = project(stepped(lens, -step), direction);
    if (!plus || !minus) return std::nullopt;
    jacobian.col(i) = (*plus - *minus) / (2 * half);
  }
  return jacobian;
}

}  // namespace

Lens stepped(const Lens& lens, const LensStep& step) noexcept {
  Lens next = lens;
  next.fx_px += step[0], next.fy_px += step[1], next.cx_px += step[2], next.cy_px += step[3];
  for (int i = 0; i < 5; ++i) next.coefficients[static_cast<std::size_t>(i)] += step[4 + i];
  next.distortion_centre_px += step.tail<2>();
  return next;
}

double lens_deviation_px(const Lens& lens, const LensCovariance& covariance, double angle_rad) noexcept {
  constexpr int kAround = 8;
  double sum2 = 0;
  int count = 0;
  for (int i = 0; i < kAround; ++i) {
    const double around = 2 * std::numbers::pi * i / kAround;
    const auto jacobian = pixel_jacobian(lens, covariance,
                                         {std::sin(angle_rad) * std::cos(around),
                                          std::sin(angle_rad) * std::sin(around), std::cos(angle_rad)});
    if (!jacobian) continue;
    sum2 += (*jacobian * covariance * jacobian->transpose()).trace() / 2;
    ++count;
  }
  return count > 0 ? std::sqrt(std::fmax(0.0, sum2 / count)) : 0;
}

}  // namespace orcart
