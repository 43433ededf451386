// Where a tracked marker was at any instant: its noisy samples, smoothed so that noise has no favourite
// phase.
#pragma once

#include <optional>
#include <vector>

#include "realtime/geometry/pose.hpp"

namespace orcart {

/// One sample of the tracker; seconds on any clock, the same for tracker and video.
struct TrackedPose {
  double at_s = 0;
  Pose<T, S> X_TS;
};

/// Local quadratic regression with Gaussian weights (Fan and Gijbels 1996) of place and rotation vector.
/// Interpolation between two samples would average their noise at mid-way and not beside them, so that what
/// is fitted to it leans towards mid-way; this does not. Any thread may call; nothing changes after
/// construction.
class PoseTrack {
 public:
  /// Samples must rise in time. `smooth_s` is the weights' standard deviation; not less than the samples are
  /// apart.
  PoseTrack(std::vector<TrackedPose> samples, double smooth_s);

  /// Nothing within 1.5 smooth_s of the samples' ends and of gaps of more than four times smooth_s: there the
  /// regression leans on one side, is noisier, and a fit would shun it.
  std::optional<Pose<T, S>> at(double t_s) const;

  const std::vector<TrackedPose>& samples() const { return samples_; }
  double smooth_s() const { return smooth_s_; }

 private:
  std::vector<TrackedPose> samples_;
  std::vector<double> run_begins_s_, run_ends_s_;  ///< of the run without gaps that each sample is in
  double smooth_s_;
};

/// How wide to smooth samples that are so far apart: 2 periods at 60 Hz and above, 1.2 at 30 Hz, where more
/// would take the swift parts of a movement away.
double smoothing_s(double period_s);

/// The median time from one sample to the next, seconds; 0 for fewer than two.
double usual_period_s(const std::vector<TrackedPose>& samples);

}  // namespace orcart
