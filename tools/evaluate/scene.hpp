// What a simulated set-up happens in: the surface, the scope, the marker bodies, and views of chance.
#pragma once

#include <optional>
#include <vector>

#include "realtime/geometry/ray_scene.hpp"
#include "realtime/optics/scope_model.hpp"
#include "tools/evaluate/random_stream.hpp"

namespace orcart {

/// Lent to every set-up; immutable.
struct EvaluationScene {
  const TriangleMesh& mesh;
  const RayScene& rays;
  const ScopeModel& scope;
  SeenFrom seen_from = SeenFrom::inside;
  Pose<M, R> X_MR;
  std::vector<Eigen::Vector3d> scope_markers_mm, reference_markers_mm;  ///< in S and R
};

/// The same scene through another scope, which is lent: the passport at a turn of the light post.
inline EvaluationScene through(const EvaluationScene& scene, const ScopeModel& scope) {
  return {.mesh = scene.mesh,
          .rays = scene.rays,
          .scope = scope,
          .seen_from = scene.seen_from,
          .X_MR = scene.X_MR,
          .scope_markers_mm = scene.scope_markers_mm,
          .reference_markers_mm = scene.reference_markers_mm};
}

/// A view of chance: at a random point of the surface, backed off along its normal as far as there is room
/// (4 to 25 mm), tilted by up to 25 degrees, rolled at will, at least 2 mm from any wall. Nothing where a
/// hundred tries found no such place.
std::optional<Pose<M, C>> view_of_chance(const EvaluationScene& scene, RandomStream& random);

/// A point of the surface that a view shows, and the pixel that it is seen at.
struct Landmark {
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();  ///< M
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< of its triangle, towards the camera
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// Through a pixel, where the surface may be painted: within the mask, nearer than far_mm, the painted side,
/// no steeper than 80 degrees.
std::optional<Landmark> landmark_at(const EvaluationScene& scene, const Pose<M, C>& X_MC,
                                    const Eigen::Vector2d& pixel);

/// Evenly over the picture's circle.
std::vector<Landmark> landmarks_of_chance(const EvaluationScene& scene, const Pose<M, C>& X_MC,
                                          std::size_t count, RandomStream& random);

/// Fiducials on a head about the surface: an ellipsoid of 75, 95 and 85 mm, upper half, spread around. M, mm.
std::vector<Eigen::Vector3d> fiducials_of_chance(const EvaluationScene& scene, int count,
                                                 RandomStream& random);

}  // namespace orcart
