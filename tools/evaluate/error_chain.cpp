// The chain of poses and the lens, with errors put in where they arise.
#include "tools/evaluate/error_chain.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "realtime/optics/scope_turn.hpp"

namespace orcart {

namespace {

struct Ray {
  Eigen::Vector3d origin_mm, direction;
};

std::optional<Ray> believed_ray(const EvaluationScene& scene, const Capture& capture,
                                const Landmark& landmark, const DrawnErrors& errors,
                                const LandmarkErrors& own) {
  const auto direction = believed_direction(scene, landmark.pixel + own.picture_px, errors);
  if (!direction) return std::nullopt;
  const Pose<M, C> X_MC = believed_pose(scene, capture, errors);
  return Ray{.origin_mm = X_MC.translation_mm, .direction = X_MC.rotation * *direction};
}

}  // namespace

Twist assumed_velocity(const ErrorModel& model) {
  Twist velocity;
  velocity << model.speed_mm_s, 0, 0, 0, model.turn_rad_s, 0;
  return velocity;
}

Pose<M, C> believed_pose(const EvaluationScene& scene, const Capture& capture, const DrawnErrors& errors) {
  const Pose<R, S> X_RS = scene.X_MR.inverse() * capture.X_MC * scene.scope.X_SC.inverse();
  const Pose<R, R> seen_reference = moved(Pose<R, R>{}, errors.reference);
  const Pose<M, S> X_MS =
      moved(scene.X_MR, errors.registration) * seen_reference.inverse() * moved(X_RS, errors.scope);
  const Pose<S, C> X_SC =
      errors.light_post_rad == 0 ? scene.scope.X_SC : optics_at(scene.scope, errors.light_post_rad).X_SC;
  return moved(X_MS * moved(X_SC, errors.hand_eye), capture.velocity * errors.time_s);
}

std::optional<Eigen::Vector3d> believed_direction(const EvaluationScene& scene, const Eigen::Vector2d& pixel,
                                                  const DrawnErrors& errors) {
  const ScopeModel& scope = scene.scope;
  const Lens lens = errors.light_post_rad == 0 ? scope.lens : optics_at(scope, errors.light_post_rad).lens;
  const Eigen::Vector2d centre(scope.lens.cx_px, scope.lens.cy_px), out = pixel - centre;
  const double part = out.norm() / scope.mask.radius_px;
  const double stretch = errors.lens[2] + errors.lens[3] / scope.mask.radius_px * part * part;
  const Eigen::Vector2d moved_pixel = pixel + errors.lens.head<2>() + stretch * out;
  auto direction = direction_of(stepped(lens, errors.lens_numbers), moved_pixel);
  if (!direction || errors.refraction == 0) return direction;
  const double sine = direction->head<2>().norm() * (1 + errors.refraction);  // Snell at a flat window
  if (sine >= 1) return std::nullopt;
  direction->head<2>() *= 1 + errors.refraction;
  direction->z() = std::sqrt(1 - sine * sine);
  return direction;
}

Eigen::Matrix<double, 3, 2> tangents_of(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  return tangents;
}

std::optional<Eigen::Vector3d> painted_place(const EvaluationScene& scene, const Capture& capture,
                                             const Landmark& landmark, const DrawnErrors& errors,
                                             const LandmarkErrors& own) {
  const auto ray = believed_ray(scene, capture, landmark, errors, own);
  if (!ray) return std::nullopt;
  const auto hit = scene.rays.nearest(ray->origin_mm.cast<float>(), ray->direction.cast<float>(),
                                      static_cast<float>(2 * scene.scope.far_mm));
  if (!hit) return std::nullopt;
  return ray->origin_mm + static_cast<double>(hit->distance_mm) * ray->direction +
         tangents_of(landmark.normal) * own.texel_mm;
}

std::optional<Eigen::Vector3d> painted_on_plane(const EvaluationScene& scene, const Capture& capture,
                                                const Landmark& landmark, const DrawnErrors& errors,
                                                const LandmarkErrors& own) {
  const auto ray = believed_ray(scene, capture, landmark, errors, own);
  if (!ray) return std::nullopt;
  const double along = ray->direction.dot(landmark.normal);
  if (along > -1e-6) return std::nullopt;
  const double distance = (landmark.place_mm - ray->origin_mm).dot(landmark.normal) / along;
  return ray->origin_mm + distance * ray->direction + tangents_of(landmark.normal) * own.texel_mm;
}

}  // namespace orcart
