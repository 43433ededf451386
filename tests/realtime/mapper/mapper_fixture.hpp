// A scope, surfaces and the collecting of a whole view: what the mapper's tests share.
#pragma once

#include <algorithm>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "realtime/mapper/mapper.hpp"
#include "tests/realtime/geometry/analytic_meshes.hpp"

namespace orcart::testing {

/// A pinhole of 640x480 whose mask circle lies at the cone's half angle of 35 degrees.
inline ScopeModel pinhole_scope() {
  ScopeModel scope;
  scope.width_px = 640;
  scope.height_px = 480;
  scope.cone_half_angle_rad = 35 * std::numbers::pi / 180;
  scope.far_mm = 60;
  scope.lens = {.fx_px = 300, .fy_px = 300, .cx_px = 320, .cy_px = 240, .max_angle_rad = 1.2};
  scope.mask = {.cx_px = 320, .cy_px = 240, .radius_px = 300 * std::tan(scope.cone_half_angle_rad)};
  return scope;
}

inline Surface surface_of(TriangleMesh mesh) {
  return {.mesh = std::move(mesh), .identity = {}, .closed = false};
}

/// A camera at `tip_mm` that looks at `target_mm`; `up` must not be parallel.
inline Pose<M, C> looking(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& target_mm,
                          const Eigen::Vector3d& up = {0, -1, 0}) {
  const Eigen::Vector3d z = (target_mm - tip_mm).normalized();
  const Eigen::Vector3d x = z.cross(up).normalized();
  Pose<M, C> X_MC;
  X_MC.rotation << x, z.cross(x), z;
  X_MC.translation_mm = tip_mm;
  return X_MC;
}

/// All parts of a view as one, both lists sorted.
struct WholeView {
  std::vector<std::uint32_t> painted, occluders;
  CutoutPatch last;
  std::size_t parts = 0;
  std::size_t in_cone() const { return painted.size() + occluders.size(); }
};

inline WholeView whole_view(Mapper& mapper, const Pose<M, C>& X_MC, const MapperLimits& limits = {},
                            TextureMode mode = TextureMode::perspective) {
  WholeView view;
  view.last = CutoutPatch(patch_capacity(limits));
  mapper.begin(X_MC, mode);
  while (mapper.next(view.last)) {
    ++view.parts;
    view.painted.insert(view.painted.end(), view.last.triangles.begin(), view.last.triangles.end());
    view.occluders.insert(view.occluders.end(), view.last.occluders.begin(), view.last.occluders.end());
  }
  std::sort(view.painted.begin(), view.painted.end());
  std::sort(view.occluders.begin(), view.occluders.end());
  return view;
}

}  // namespace orcart::testing
