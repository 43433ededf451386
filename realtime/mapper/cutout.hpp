// Cuts out of the surface what one view's cone meets, for consumers that want a mesh with texture coordinates
// or ranges to draw.
#pragma once

#include <cstdint>

#include "realtime/base/result.hpp"
#include "realtime/geometry/cone_walk.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "realtime/mapper/cone_clip.hpp"
#include "realtime/mapper/cone_sieve.hpp"
#include "realtime/mapper/cutout_mesh.hpp"
#include "realtime/mapper/five_rays.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

enum class CutoutForm : std::uint8_t {
  whole,  ///< whole triangles
  clip,   ///< cut where their edges cross the cone; straight lines between the crossings
};

/// Where an emission stands: the walk, and the run of clusters it has not finished.
struct CutoutProgress {
  ConeWalk walk;
  ClusterRun run;  ///< empty where first == end
  CutoutForm form = CutoutForm::whole;
  CutoutRule rule = CutoutRule::touching;
  float s_per_mm = 0, t_per_mm = 0;
  SieveScratch scratch;
  ConeExits exits;
};

/// Real-time after construction; belongs to one thread. Borrows the tree and the rays, which outlive it. The
/// same triangles of a cone as Mapper's perspective mode, without the question of facing and hiding.
class Cutout {
 public:
  Cutout(const ClusterTree& tree, const RayScene& rays, const ScopeModel& scope,
         CutoutRule rule = CutoutRule::touching);

  /// Starts a view: five rays through the rectified picture's centre and edges, and the scale they give.
  void begin(const Pose<M, C>& X_MC, CutoutForm form) noexcept;
  /// Fills `mesh` with as many of the view's triangles as it has room for; false, mesh untouched, after the
  /// last part. Each view has at least one part.
  bool next(CutoutMesh& mesh) noexcept;
  /// The whole view as ranges; nothing is carried.
  void ranges(const Pose<M, C>& X_MC, CutoutRanges& ranges) noexcept;

 private:
  const ClusterTree& tree_;
  const RayScene& surface_;
  CutoutRule rule_;
  double half_angle_rad_;
  ViewingCone cone_;
  FiveDirections directions_;
  FiveRays rays_;
  PaperProjection paper_;
  CutoutProgress progress_;
  bool first_ = true, done_ = true;
};

}  // namespace orcart
