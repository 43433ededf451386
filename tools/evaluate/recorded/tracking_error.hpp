// The paper's tracking error for a recorded set: measured on tools that stood still, else implied by the
// views.
#pragma once

#include <optional>

#include "tools/calibration/hand_eye_command.hpp"
#include "tools/evaluate/recorded/still_tools.hpp"

namespace orcart {

enum class TrackingFrom {
  rests,    ///< measured: the same pose read again and again
  implied,  ///< not measured: the noise that would make the views' poses disagree as they do
  nothing,  ///< neither
};

struct TrackingError {
  TrackingFrom from = TrackingFrom::nothing;
  Statistics error;      ///< of a place, in 3-D; an implied one has no maximum (not a number)
  StillTools still;      ///< where it was measured
  double marker_mm = 0;  ///< implied: RMS of one marker in 3-D
};

/// Recordings given: measured in them. Refuses those in which nothing stands still. Else implied.
Result<TrackingError> tracking_error(const std::vector<std::filesystem::path>& recordings,
                                     const HandEyeCalibration& calibration);

/// The declared noise times the root of the hand-eye's misfit, as a body's place: mean, s.d. and 95 % of the
/// length of a vector alike in all directions (Maxwell). The confidence is the misfit's (chi-square, after
/// Wilson and Hilferty 1931). It holds everything that makes poses and pictures disagree, turns above all.
std::optional<Statistics> implied_tracking(const HandEyeCalibration& calibration);

}  // namespace orcart
