// The three lens models written for automatic differentiation; the same formulas as realtime/optics.
#pragma once

#include <array>
#include <cmath>

#include <ceres/jet.h>
#include <ceres/rotation.h>

#include "realtime/optics/lens_covariance.hpp"

namespace orcart {

/// Intrinsics as one block: fx fy cx cy, five coefficients, distortion centre x y. poly4's coefficients are
/// stored times scale_px, its square and its cube, so that all are of one size.
constexpr int kIntrinsics = 11;
using Intrinsics = std::array<double, kIntrinsics>;
constexpr double kPolynomialScale_px = 500;

Intrinsics intrinsics_of(const Lens& lens);
Lens lens_of(LensModel model, const Intrinsics& intrinsics);
static_assert(kIntrinsics == kLensNumbers);
/// poly4's scales taken out.
LensCovariance covariance_in_lens_units(LensModel model, const LensCovariance& of_intrinsics);

inline double value_of(double x) {
  return x;
}
template <class T, int N>
double value_of(const ceres::Jet<T, N>& x) {
  return x.a;
}

namespace lens_cost {

template <class T>
void brown(const T* k, const T& x, const T& y, T* pixel) {
  const T r2 = x * x + y * y;
  const T radial = T(1) + r2 * (k[4] + r2 * (k[5] + r2 * k[8]));
  const T xd = x * radial + T(2) * k[6] * x * y + k[7] * (r2 + T(2) * x * x);
  const T yd = y * radial + k[6] * (r2 + T(2) * y * y) + T(2) * k[7] * x * y;
  pixel[0] = k[0] * xd + k[2];
  pixel[1] = k[1] * yd + k[3];
}

template <class T>
void fisheye(const T* k, const T& x, const T& y, const T& z, T* pixel) {
  using std::atan2, std::sqrt;
  const T r = sqrt(x * x + y * y + T(1e-18));
  const T theta = atan2(r, z), t2 = theta * theta;
  const T radial = theta * (T(1) + t2 * (k[4] + t2 * (k[5] + t2 * (k[6] + t2 * k[7])))) / r;
  pixel[0] = k[0] * x * radial + k[2];
  pixel[1] = k[1] * y * radial + k[3];
}

/// The root in plain numbers, then one step of Newton's with derivatives, which makes the derivative exact.
template <class T>
void poly4(const T* k, const T& x, const T& y, T* pixel) {
  using std::sqrt;
  const T a2 = k[4] / kPolynomialScale_px, a3 = k[5] / (kPolynomialScale_px * kPolynomialScale_px),
          a4 = k[6] / (kPolynomialScale_px * kPolynomialScale_px * kPolynomialScale_px);
  const T u = k[0] * x + k[2] - k[9], v = (k[1] * y + k[3] - k[10]) * k[0] / k[1];
  const T corrected = sqrt(u * u + v * v + T(1e-12));
  double root = value_of(corrected);
  const double b2 = value_of(a2), b3 = value_of(a3), b4 = value_of(a4), target = value_of(corrected);
  for (int i = 0; i < 40; ++i) {
    const double slope = 1 + root * (2 * b2 + root * (3 * b3 + root * 4 * b4));
    const double step = (root * (1 + root * (b2 + root * (b3 + root * b4))) - target) / std::fmax(slope, 0.1);
    root = std::fmax(0.0, root - step);
    if (std::abs(step) < 1e-12) break;
  }
  const T value = root * (T(1) + root * (a2 + root * (a3 + root * a4)));
  const double slope = std::fmax(1 + root * (2 * b2 + root * (3 * b3 + root * 4 * b4)), 0.1);
  const T factor = (T(root) - (value - corrected) / slope) / corrected;
  pixel[0] = k[9] + u * factor;
  pixel[1] = k[10] + v * factor * k[1] / k[0];
}

/// False for a point behind the camera, where the perspective models have no answer.
template <class T>
bool project(LensModel model, const T* intrinsics, const T* p_C, T* pixel) {
  if (model == LensModel::fisheye) {
    fisheye(intrinsics, p_C[0], p_C[1], p_C[2], pixel);
    return true;
  }
  if (value_of(p_C[2]) < 1e-6) return false;
  const T x = p_C[0] / p_C[2], y = p_C[1] / p_C[2];
  if (model == LensModel::brown) {
    brown(intrinsics, x, y, pixel);
  } else {
    poly4(intrinsics, x, y, pixel);
  }
  return true;
}

/// pose: three numbers of the rotation vector, three of the translation.
template <class T, class P>
void transform(const T* pose, const P* point, T* result) {
  const T from[3] = {T(point[0]), T(point[1]), T(point[2])};
  ceres::AngleAxisRotatePoint(pose, from, result);
  for (int i = 0; i < 3; ++i) result[i] += pose[3 + i];
}

}  // namespace lens_cost
}  // namespace orcart
