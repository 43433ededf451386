// One draw of all errors, and where it makes a picture's light land on the surface.
#pragma once

#include "realtime/geometry/twist.hpp"
#include "tools/evaluate/error_model.hpp"
#include "tools/evaluate/scene.hpp"

namespace orcart {

/// Everything that is wrong in one set-up at one capture. Zero: the truth.
struct DrawnErrors {
  Twist scope = Twist::Zero();                     ///< of the fitted scope body, in S
  Twist reference = Twist::Zero();                 ///< of the fitted reference body, in R
  Twist registration = Twist::Zero();              ///< of X_MR, in R
  Twist hand_eye = Twist::Zero();                  ///< of X_SC, in C
  Eigen::Vector4d lens = Eigen::Vector4d::Zero();  ///< centre x, y (px), focal (relative), edge (px)
  LensStep lens_numbers = LensStep::Zero();        ///< added to the lens's own numbers
  double refraction = 0;                           ///< relative
  double light_post_rad = 0;                       ///< the turn is believed to be more by this
  double time_s = 0;                               ///< the pose is this much later than the picture
};

/// Errors of one landmark beside those of its set-up.
struct LandmarkErrors {
  Eigen::Vector2d picture_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d texel_mm = Eigen::Vector2d::Zero();  ///< within its texel, along the surface
};

/// A capture: the true pose and how the scope moved.
struct Capture {
  Pose<M, C> X_MC;
  Twist velocity = Twist::Zero();  ///< mm/s and rad/s, in C
};

/// As the model takes for granted: along the picture's x, turning about its y.
Twist assumed_velocity(const ErrorModel& model);

/// X_MC as the cart believes it: X_MR X_TR^-1 X_TS X_SC, each factor with its error.
Pose<M, C> believed_pose(const EvaluationScene& scene, const Capture& capture, const DrawnErrors& errors);

/// The direction in C that the cart believes a pixel to see.
std::optional<Eigen::Vector3d> believed_direction(const EvaluationScene& scene, const Eigen::Vector2d& pixel,
                                                  const DrawnErrors& errors);

/// Where the light of a landmark is painted: the ray of its pixel through the believed lens from the believed
/// pose, to the surface. Nothing where that ray misses.
std::optional<Eigen::Vector3d> painted_place(const EvaluationScene& scene, const Capture& capture,
                                             const Landmark& landmark, const DrawnErrors& errors,
                                             const LandmarkErrors& own);

/// The same to the landmark's tangent plane in place of the surface: what propagation linearises.
std::optional<Eigen::Vector3d> painted_on_plane(const EvaluationScene& scene, const Capture& capture,
                                                const Landmark& landmark, const DrawnErrors& errors,
                                                const LandmarkErrors& own);

/// Two unit vectors along a surface with the given normal.
Eigen::Matrix<double, 3, 2> tangents_of(const Eigen::Vector3d& normal);

}  // namespace orcart
