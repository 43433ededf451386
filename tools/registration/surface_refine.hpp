// A registration made better with pointer points on the surface, and how sure it then is anywhere.
#pragma once

#include <vector>

#include "realtime/geometry/triangle_mesh.hpp"
#include "tools/registration/register_points.hpp"

namespace orcart {

struct SurfaceTask {
  std::vector<Eigen::Vector3d> points_R_mm;  ///< touched with the pointer, anywhere on the surface
  double error_mm = 0.5;  ///< standard deviation of their distance from it: pointer and surface
};

struct SurfaceRefinement {
  double before_mm = 0, after_mm = 0;  ///< RMS distance of the points used from the surface
  std::size_t used = 0, left_out = 0;  ///< points; those far off are left out
  double moved_mm = 0;                 ///< the fiducials' middle
};

/// Point-to-plane registration (Chen and Medioni 1992) that keeps the fiducials as observations, each with
/// its declared error, so that points cannot slide along the surface. Changes the pose, FRE and the predicted
/// error of `registration`. Refuses fewer than six points, and points that do not lie at the surface.
Result<SurfaceRefinement> refine_on_surface(Registration& registration, const TriangleMesh& mesh,
                                            const SurfaceTask& task);

struct SurfaceTre {
  double mean_mm = 0, p95_mm = 0, worst_mm = 0;
  Eigen::Vector3d worst_at_mm = Eigen::Vector3d::Zero();
};
/// The predicted error at every vertex of the surface.
SurfaceTre tre_over_surface(const Registration& registration, const TriangleMesh& mesh);

}  // namespace orcart
