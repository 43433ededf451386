// The patient's reference in mesh space from paired points, with what such a registration may be trusted for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "realtime/geometry/twist.hpp"
#include "tools/registration/points_file.hpp"

namespace orcart {

enum class Pairing { by_name, by_order, unknown };

struct RegistrationTask {
  std::vector<NamedPoint> fixed;   ///< in M
  std::vector<NamedPoint> moving;  ///< in R
  /// Unset: by name where all names of one side are there, by order where none is alike.
  std::optional<Pairing> pairing;
  double fle_mm = 0.5;  ///< fiducial localisation error, RMS, declared: never taken from this patient's FRE
};

struct RegisteredPoint {
  std::string fixed, moving;
  Eigen::Vector3d fixed_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d moving_mm = Eigen::Vector3d::Zero();  ///< in R
  double error_mm = 0;
};

struct Registration {
  Pose<M, R> X_MR;
  double fre_mm = 0;
  std::vector<RegisteredPoint> points;
  std::string outlier;    ///< name of the fixed point left out; empty where none was
  double outlier_mm = 0;  ///< how far it lies off
  Eigen::Vector3d centroid_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();     ///< principal axes of the fiducials, columns
  Eigen::Vector3d spread2_mm2 = Eigen::Vector3d::Ones();  ///< mean squared distance from each axis
  double fle_mm = 0;
  /// Of the pose's turn and shift about centroid_mm, in M; where surface points were used beside the
  /// fiducials.
  std::optional<Eigen::Matrix<double, 6, 6>> pose_covariance;
  std::string shape;               ///< of the notes, what a flat or narrow set means; empty: it is neither
  std::vector<std::string> notes;  ///< e.g. what a nearly flat set does to the error beside it
};

/// Refuses fewer than three pairs, points on one line, names that do not pair up (and, unless `pairing` says
/// so, lists of which only some names are alike), sets of unlike size (metres), and an FRE of over ten times
/// the declared FLE.
Result<Registration> register_points(const RegistrationTask& task);

/// Puts among the notes what a flat or narrow set does to the error beside it, in place of what was told
/// before; for whoever changes the registration.
void tell_shape(Registration& registration);

/// Of X_MR: a twist in R (mm, rad), from the declared fiducial error.
TwistCovariance twist_covariance(const Registration& registration);

/// Each fiducial's error and the expected error away from them; `more` is HTML put below. `text` is the
/// answer as the terminal shows it.
std::string register_page(const Registration& registration, const std::string& text, const std::string& more);

/// Expected target registration error, RMS, at a place of the mesh (Fitzpatrick, West and Maurer 1998,
/// equation 46); by the pose's covariance where there is one.
double predicted_tre_mm(const Registration& registration, const Eigen::Vector3d& target_mm);

}  // namespace orcart
