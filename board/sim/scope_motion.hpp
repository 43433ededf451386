// The scope's pose at any instant of a procedure: smooth moves between places, the hand's drift and tremor,
// slow roll.
#pragma once

#include "board/sim/path_planner.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/geometry/pose.hpp"

namespace orcart {

/// Pure in time; any thread may ask. Time counts from the procedure's start; before and after it the scope
/// rests.
class ScopeMotion {
 public:
  ScopeMotion(ScopeWay way, const ProcedureScript& script) : way_(std::move(way)), script_(script) {}

  Pose<M, C> X_MC(Nanos since_start) const noexcept;
  /// When the scope comes to rest at place i.
  Nanos arrival(std::size_t place) const noexcept;
  const ScopeWay& way() const noexcept { return way_; }

 private:
  RestingPlace between_places(double at_s) const noexcept;

  ScopeWay way_;
  ProcedureScript script_;
};

}  // namespace orcart
