// A calibrated endoscope: what scope.toml, the calibration passport, says of it.
#pragma once

#include <optional>
#include <string>

#include "realtime/geometry/twist.hpp"
#include "realtime/optics/lens.hpp"
#include "realtime/optics/lens_covariance.hpp"

namespace orcart {

enum class Medium { air, water, saline };

/// The circle of the picture that shows something.
struct CircularMask {
  double cx_px = 0, cy_px = 0;
  double radius_px = 0;     ///< along x; along y it is radius_px * fy/fx (anamorphic pixels)
  double soft_edge_px = 6;  ///< paint fades to nothing over this width inside the circle
};

/// How brightness falls: image = radiance * (reference_mm / distance)^2 * vignetting(angle). Used to even
/// views out.
struct FallOff {
  double reference_mm = 20;         ///< distance at which the compensation is 1
  double vignetting_cos_power = 0;  ///< vignetting = cos(angle)^power
};

/// What the scope's marker body sits on.
enum class TurnMarker { shaft, head };

/// A scope that can be turned against its camera head, as angled ones are. See scope_turn.hpp.
struct Turning {
  double view_angle_rad = 0;  ///< between view and shaft, as engraved or measured: 0, 30, 45, 70 degrees
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< what the picture turns about on the sensor
  double centre_deviation_px = 0;                       ///< standard deviation of it
  TurnMarker marker = TurnMarker::shaft;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of the shaft, towards the tip, in S; head, or R_SL
  Eigen::Vector3d axis_point_mm = Eigen::Vector3d::Zero();  ///< head: a point on it, in S
  std::optional<Eigen::Matrix3d> R_SL;  ///< of the second marker at turn 0; nothing: it has none
  std::optional<double>
      notch_deviation_rad;  ///< standard deviation of a turn by the notch; nothing: not known
};

/// The passport. Immutable after loading.
struct ScopeModel {
  std::string name;
  std::string serial;  ///< as engraved on the scope; empty where it was not told
  int width_px = 0, height_px = 0;
  Lens lens;
  CircularMask mask;
  double cone_half_angle_rad = 0;  ///< of the viewing cone about C's z axis: what the mapper clips with
  double far_mm = 60;              ///< paint nothing beyond this distance from C
  Pose<S, C> X_SC;                 ///< hand-eye: camera in scope marker
  Pose<C, E> X_CE;                 ///< distal window in camera: on its z axis, unless a file says otherwise
  FallOff fall_off;
  Medium medium = Medium::air;
  std::string calibrated_on;        ///< ISO date
  std::string expires_on;           ///< ISO date; empty where it never does
  double residual_px = 0;           ///< RMS of the calibration, pixels
  double residual_mm = 0;           ///< RMS of the hand-eye, mm
  std::optional<double> notch_rad;  ///< of the mask's notch about its centre, from x towards y, square pixels
  std::optional<Turning> turning;   ///< nothing: head and scope are one piece, or are never turned
  /// What the calibration leaves open; nothing where it is not known. Lens and hand-eye are told apart as if
  /// they were independent.
  std::optional<LensCovariance> lens_covariance;
  std::optional<TwistCovariance> hand_eye_covariance;  ///< of X_SC: a twist in C
  /// Of X_CE's place in C, mm^2. Nothing across C's z axis where E is on it by its definition.
  std::optional<Eigen::Matrix3d> window_covariance;
};

}  // namespace orcart
