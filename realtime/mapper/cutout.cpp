// A view's beginning: the cone, its rays, its scale. The triangles are cutout_emit's.
#include "realtime/mapper/cutout.hpp"

#include <algorithm>

#include "realtime/mapper/cutout_emit.hpp"

namespace orcart {

CutoutMesh::CutoutMesh(std::size_t max_triangles) {
  corners.resize(std::max(max_triangles, kClippedClusterTriangles) + kEmitPadding);
  for (std::vector<float>* each : {&x_mm, &y_mm, &z_mm, &s, &t})
    each->resize(3 * corners.size() + kClippedClusterVertices);
}

Cutout::Cutout(const ClusterTree& tree, const RayScene& rays, const ScopeModel& scope, CutoutRule rule)
    : tree_(tree),
      surface_(rays),
      rule_(rule),
      half_angle_rad_(scope.cone_half_angle_rad),
      cone_(viewing_cone({}, {.half_angle_rad = scope.cone_half_angle_rad, .far_mm = scope.far_mm})),
      directions_(rectified_directions(scope)) {}

void Cutout::begin(const Pose<M, C>& X_MC, CutoutForm form) noexcept {
  rays_ = trace_five_rays(surface_, X_MC, directions_, cone_.far_mm);
  paper_ = paper_projection(X_MC, rays_, half_angle_rad_);
  progress_.run = {};
  progress_.form = form;
  progress_.rule = rule_;
  progress_.s_per_mm = paper_.valid ? 1 / paper_.s_size_mm : 0;
  progress_.t_per_mm = paper_.valid ? 1 / paper_.t_size_mm : 0;
  cone_.aim(X_MC);
  if (paper_.valid)
    progress_.walk.begin(tree_, cone_);
  else
    progress_.walk = ConeWalk{};  // over before it begins: there is no centre
  first_ = true;
  done_ = false;
}

bool Cutout::next(CutoutMesh& mesh) noexcept {
  if (done_) return false;
  mesh.rays = rays_;
  mesh.paper = paper_;
  mesh.first_part = first_;
  mesh.vertices = mesh.triangles = mesh.with_corner = mesh.uncut = 0;
  done_ = emit_cutout(tree_, progress_, mesh);
  mesh.last_part = done_;
  first_ = false;
  return true;
}

void Cutout::ranges(const Pose<M, C>& X_MC, CutoutRanges& ranges) noexcept {
  cone_.aim(X_MC);
  progress_.walk.begin(tree_, cone_);
  collect_ranges(tree_, progress_.walk, ranges);
  done_ = true;
}

}  // namespace orcart
