// How badly the marker's motion explains what the camera saw of one movement, lag by lag; and where movements
// begin and end.
#pragma once

#include <span>
#include <vector>

#include "tools/calibration/time_lag.hpp"

namespace orcart {

struct MisfitCurve {
  std::vector<double> squares;  ///< sum of squares that is left, for each lag; mm^2 or rad^2
  double motion = 0;            ///< sum of squares of the motion itself
  double freedom = 1;           ///< numbers seen less numbers fitted
  std::size_t samples = 0;      ///< 0: nothing was seen of it for all lags
};

struct MisfitTask {
  std::span<const double> lags_s;
  Pose<S, C> X_SC;
};

/// Over the samples with stamps in `window` for which the track has an answer at every lag.
MisfitCurve misfit_curve(const PoseTrack& track, const ImageMotion& motion, const Stretch_s& window,
                         const MisfitTask& task);

}  // namespace orcart
