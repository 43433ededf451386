// An angled scope whose light post turns against the camera head: the passport's optics at any turn.
#pragma once

#include <optional>

#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// What of a passport depends on the turn.
struct TurnedOptics {
  Lens lens;
  CircularMask mask;
  Pose<S, C> X_SC;
  Pose<C, E> X_CE;
  std::optional<double> notch_rad;  ///< as ScopeModel::notch_rad
};

/// The optics when the picture has turned by `turn_rad` (from x towards y, in pixels made square) since the
/// passport was made: what the notch has turned by. On the sensor everything goes round turning.centre_px, as
/// an eyepiece does in its coupler. That is a turn of C about its z axis with centre, mask and decentring
/// carried round (a radial lens does not notice the turn), so the lens models stay as they are. With the
/// marker on the head the optics turn under it, about turning.axis; with the marker on the shaft they stay
/// (Yamaguchi 2004, Wu and Jaramaz 2007). A passport without turning is answered as it is. Any thread;
/// nothing is allocated.
TurnedOptics optics_at(const ScopeModel& scope, double turn_rad) noexcept;

/// The shaft's direction towards the tip, in C at these optics: C's z axis where the passport has no turning.
/// Nothing where an angled scope's passport does not tell it (the marker on the shaft and no second one). Any
/// thread; nothing is allocated.
std::optional<Eigen::Vector3d> shaft_of(const ScopeModel& scope, const TurnedOptics& at) noexcept;

/// What two markers on either side of the coupler say of the turn.
struct MarkedTurn {
  double turn_rad = 0;   ///< about the calibrated axis, -pi..pi
  double swing_rad = 0;  ///< what is left across the axis: noise, or a marker that was bent or slipped
};

/// The turn by the second marker's rotation in S, now; turning.R_SL must be there. The rotation since turn 0
/// is split into a twist about the axis and a swing across it (swing-twist decomposition of a quaternion).
/// Any thread; nothing is allocated.
MarkedTurn turn_of(const Turning& turning, const Eigen::Matrix3d& R_SL) noexcept;

/// The second marker's rotation in S at a turn: the inverse of turn_of.
Eigen::Matrix3d second_marker_at(const Turning& turning, double turn_rad) noexcept;

/// The whole passport at a turn; its own turning is for the new zero. Off the real-time path.
ScopeModel turned(const ScopeModel& scope, double turn_rad);

}  // namespace orcart
