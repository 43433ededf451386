// The scope's lens: from a direction in the camera frame to a pixel and back, for three models of distortion.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace orcart {

enum class LensModel {
  brown,  ///< Brown 1966 as OpenCV orders it: k1 k2 p1 p2 k3 (normalised radius to distorted radius)
  poly4,  ///< Haneishi 1995: corrected radius = r + a2 r^2 + a3 r^3 + a4 r^4, r the DISTORTED radius about a
          ///< centre
  fisheye,  ///< Kannala-Brandt 2006: theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
};

/// Intrinsics and distortion. Pixels have their origin at the centre of the top-left pixel, x right, y down.
/// Immutable after loading; any thread may call. Nothing here allocates.
struct Lens {
  LensModel model = LensModel::brown;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  /// brown: k1 k2 p1 p2 k3. fisheye: k1 k2 k3 k4 0. poly4: a2 a3 a4 0 0 in powers of 1/px, radius in pixels
  /// made square (y scaled by fx/fy), about distortion_centre_px.
  std::array<double, 5> coefficients{};
  Eigen::Vector2d distortion_centre_px = Eigen::Vector2d::Zero();  ///< poly4 only
  /// The largest angle off the optical axis at which the model is monotone, radians
  /// (largest_monotone_angle_rad).
  double max_angle_rad = 0;
};

/// The pixel that sees a point of the camera frame (mm), distortion included; nothing behind the camera or
/// beyond lens.max_angle_rad.
std::optional<Eigen::Vector2d> project(const Lens& lens, const Eigen::Vector3d& p_C_mm);

/// The unit direction in the camera frame that a pixel sees; the inverse of project() to 1e-9 px within
/// lens.max_angle_rad, nothing beyond it.
std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel);

/// How far from the axis the model stays monotone (radius grows with angle), searched up to limit_rad.
double largest_monotone_angle_rad(const Lens& lens, double limit_rad);

}  // namespace orcart
