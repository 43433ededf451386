// Directions, hits and the lateral size of the picture on the surface.
#include "realtime/mapper/five_rays.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace orcart {
namespace {

/// The lateral size from two opposite edges; `fallback_mm` where both rays missed.
float lateral_size_mm(float first_mm, float second_mm, float fallback_mm) {
  if (first_mm >= 0 && second_mm >= 0) return first_mm + second_mm;
  if (first_mm >= 0) return 2 * first_mm;
  if (second_mm >= 0) return 2 * second_mm;
  return fallback_mm;
}

}  // namespace

FiveDirections rectified_directions(const ScopeModel& scope) {
  const double s = std::sin(scope.cone_half_angle_rad), c = std::cos(scope.cone_half_angle_rad);
  return {Eigen::Vector3d::UnitZ(), {-s, 0, c}, {s, 0, c}, {0, -s, c}, {0, s, c}};
}

FiveDirections lens_directions(const ScopeModel& scope) {
  FiveDirections directions = rectified_directions(scope);
  const CircularMask& mask = scope.mask;
  const double rx = mask.radius_px, ry = mask.radius_px * scope.lens.fy_px / scope.lens.fx_px;
  const std::array<Eigen::Vector2d, 4> offsets{{{-rx, 0}, {rx, 0}, {0, -ry}, {0, ry}}};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const Eigen::Vector2d pixel = Eigen::Vector2d(mask.cx_px, mask.cy_px) + offsets[i];
    if (const auto direction = direction_of(scope.lens, pixel)) directions[i + 1] = *direction;
  }
  return directions;
}

FiveRays trace_five_rays(const RayScene& surface, const Pose<M, C>& X_MC, const FiveDirections& directions,
                         double far_mm) noexcept {
  FiveRays rays;
  const Eigen::Vector3f origin = X_MC.translation_mm.cast<float>();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3f along = (X_MC.rotation * directions[i]).cast<float>();
    const auto hit = surface.nearest(origin, along, static_cast<float>(far_mm / directions[i].z()));
    rays.distance_mm[i] = hit ? hit->distance_mm : -1;
    if (hit) rays.hit_mm[i] = origin + hit->distance_mm * along;
  }
  return rays;
}

PaperProjection paper_projection(const Pose<M, C>& X_MC, const FiveRays& rays,
                                 double cone_half_angle_rad) noexcept {
  PaperProjection paper;
  paper.valid = rays.distance_mm[0] > 0;
  paper.tip_mm = X_MC.translation_mm.cast<float>();
  paper.view = X_MC.rotation.col(2).cast<float>();
  paper.up = -X_MC.rotation.col(1).cast<float>();
  paper.side = paper.view.cross(paper.up);
  paper.half_width_slope = static_cast<float>(std::tan(cone_half_angle_rad));
  std::array<float, 5> h{};
  for (std::size_t i = 1; i < h.size(); ++i)
    h[i] = rays.distance_mm[i] >= 0 ? (rays.hit_mm[i] - paper.tip_mm).cross(paper.view).norm() : -1;
  const float by_cone_mm = 2 * rays.distance_mm[0] * paper.half_width_slope;
  paper.s_size_mm = lateral_size_mm(h[1], h[2], by_cone_mm);
  paper.t_size_mm = lateral_size_mm(h[3], h[4], by_cone_mm);
  paper.valid = paper.valid && paper.s_size_mm > 0 && paper.t_size_mm > 0;
  return paper;
}

}  // namespace orcart
