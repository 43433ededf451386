// How fast the scope moved at each capture of a session.
#pragma once

#include <vector>

#include "firmware-host/session/session_records.hpp"
#include "tools/evaluate/error_model.hpp"

namespace orcart {

/// How many captures' velocities come from where, and their mean speeds.
struct VelocitySources {
  std::size_t stored = 0;                 ///< by the cart's own tracker samples
  std::size_t neighbours = 0;             ///< by the captures before and after in a stream
  std::size_t assumed = 0;                ///< single captures of a file that keeps none
  double speed_mm_s = 0, turn_rad_s = 0;  ///< means over those that are not assumed
};

/// A twist a second in C for each capture, in their order. As stored; else by the captures of the same press
/// within 150 ms on either side, which also hold a light post's turn; else assumed_velocity().
std::vector<Twist> capture_velocities(const std::vector<StoredCapture>& captures, const ErrorModel& model,
                                      VelocitySources& sources);

}  // namespace orcart
