// What a calibration leaves open about a lens: the covariance of its numbers, and what that makes of a pixel.
#pragma once

#include "realtime/optics/lens.hpp"

namespace orcart {

/// A lens's numbers in this order and in Lens's own units: fx fy cx cy, the five coefficients, the distortion
/// centre's x y.
inline constexpr int kLensNumbers = 11;
using LensStep = Eigen::Matrix<double, kLensNumbers, 1>;
/// Rows and columns of numbers that were held are zero.
using LensCovariance = Eigen::Matrix<double, kLensNumbers, kLensNumbers>;

/// The lens with a step added to its numbers; max_angle_rad stays.
Lens stepped(const Lens& lens, const LensStep& step) noexcept;

/// Standard deviation of the pixel that sees a direction this far off the axis, each axis: RMS over eight
/// directions around and both axes, by central differences of 0.01 standard deviations. Directions beyond the
/// lens count as nothing. Allocates nothing.
double lens_deviation_px(const Lens& lens, const LensCovariance& covariance, double angle_rad) noexcept;

}  // namespace orcart
