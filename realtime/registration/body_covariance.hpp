// How far a rigid body may be off that was fitted to noisy points.
#pragma once

#include <span>

#include "realtime/geometry/twist.hpp"

namespace orcart {

/// Of the twist, in the body's own frame, of a least-squares fit to points with isotropic noise of `sigma_mm`
/// an axis: sigma^2 (sum A'A)^-1, A = [I, -[p]x] (Dorst 2005; for a target beside the points it gives
/// Fitzpatrick, West and Maurer 1998). `points_mm` in the body's frame: three or more, not on one line.
/// Allocates nothing.
TwistCovariance body_covariance(std::span<const Eigen::Vector3d> points_mm, double sigma_mm) noexcept;

}  // namespace orcart
