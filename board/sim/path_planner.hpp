// Finds where a scope could go on a given surface: places to rest, one after the other, each showing
// something new.
#pragma once

#include <vector>

#include "board/sim/procedure_script.hpp"
#include "realtime/base/result.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// A place of C and the direction it looks in, M.
struct RestingPlace {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d view = Eigen::Vector3d::UnitZ();
};

/// The way of a procedure. Straight moves between neighbouring places keep clear of the surface.
struct ScopeWay {
  std::vector<RestingPlace> places;
  SeenFrom seen_from = SeenFrom::inside;
  Eigen::Vector3d entry_mm =
      Eigen::Vector3d::Zero();  ///< inside: the burr hole that the straight shaft pivots about
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< towards the top of the picture before the sway
};

struct PlanRequest {
  const Surface& surface;
  const RayScene& rays;
  const ScopeModel& scope;
  const ProcedureScript& script;
};

/// How many places the scope rests at.
int places_in(const ProcedureScript& script);

/// Deterministic. Fails where no place with enough room can be reached from the entry.
Result<ScopeWay> plan_way(const PlanRequest& request);

}  // namespace orcart
