// How much to brighten a pixel so that views taken from different distances match.
#pragma once

#include <algorithm>
#include <cmath>

#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// The factor on linear brightness that undoes FallOff: (distance/reference)^2 / cos(angle)^power. 1 at the
/// reference distance on the axis. Angles beyond 85 degrees count as 85.
inline double brightness_compensation(const FallOff& fall_off, double distance_mm, double angle_rad) {
  const double ratio = distance_mm / fall_off.reference_mm;
  const double cosine = std::max(std::cos(angle_rad), 0.0872);
  return ratio * ratio / std::pow(cosine, fall_off.vignetting_cos_power);
}

}  // namespace orcart
