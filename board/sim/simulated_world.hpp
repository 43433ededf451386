// The truth of a simulated procedure: where everything really is at any instant, and when the pedal is
// pressed.
#pragma once

#include <memory>
#include <vector>

#include "board/ports/gpio_lines.hpp"
#include "board/sim/scope_motion.hpp"
#include "board/sim/tool_motion.hpp"
#include "realtime/optics/scope_turn.hpp"

namespace orcart {

/// A stretch of time, [from, until), counted from the procedure's start.
struct Stretch {
  Nanos from{}, until{};
  bool holds(Nanos at) const { return from <= at && at < until; }
};

/// Tool 0 is the scope (S in T), tool 1 the reference (R in T), tool 2 a turning scope's second marker (L in
/// T). begin_at() before any thread asks; the rest from any thread. X_TS = X_TR X_MR^-1 X_MC X_SC^-1, X_SC at
/// the turn of the light post.
class SimulatedWorld final : public ToolMotion {
 public:
  static constexpr int kScopeTool = 0, kReferenceTool = 1, kSecondTool = 2;

  static Result<SimulatedWorld> create(const PlanRequest& request);

  /// The instant that the procedure's time counts from; CLOCK_MONOTONIC's zero until told.
  void begin_at(Instant start) noexcept { start_ = start; }
  Instant start() const noexcept { return start_; }
  Instant end() const noexcept { return start_ + from_seconds(script_.duration_s); }

  TrueToolPose pose_of(int tool, Instant at) const noexcept override;
  Pose<M, C> X_MC(Instant at) const noexcept { return motion_.X_MC(at - start_); }
  Pose<T, R> X_TR(Instant at) const noexcept;
  /// Of the light post since the turn of the scope's passport: a triangle wave from the start on. 0
  /// for a scope without [turning].
  double turn_rad(Instant at) const noexcept;
  /// The registration that is true; a cart's own may differ.
  const Pose<M, R>& X_MR() const noexcept { return X_MR_; }
  /// Puts the reference somewhere else on the patient; before any thread asks.
  void put_reference(const Pose<M, R>& X_MR) noexcept { X_MR_ = X_MR; }

  /// All edges of the pedal, at their instants, in order.
  std::vector<PedalEdge> pedal_edges() const;
  /// When the tracker cannot see the scope.
  const std::vector<Stretch>& hidden() const noexcept { return hidden_; }
  /// When it cannot see the second marker.
  const std::vector<Stretch>& second_hidden() const noexcept { return second_hidden_; }

  const ScopeMotion& motion() const noexcept { return motion_; }
  const ProcedureScript& script() const noexcept { return script_; }

 private:
  SimulatedWorld(ScopeMotion motion, const PlanRequest& request);
  std::size_t place_at(double share) const;
  Pose<T, S> X_TS(Instant at) const noexcept;
  bool seen(const std::vector<Stretch>& hidden, Instant at) const noexcept;

  ScopeMotion motion_;
  ProcedureScript script_;
  ScopeModel scope_;
  Pose<M, R> X_MR_;
  Pose<T, R> X_TR_;
  std::vector<Stretch> hidden_, second_hidden_;
  Instant start_{};
};

}  // namespace orcart
