// How the tracker's clock lies against the video's: the lag at which the marker's motion explains the image's
// best, and how surely.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "realtime/base/result.hpp"
#include "tools/calibration/pose_track.hpp"

namespace orcart {

/// What one frame says where a board is seen: two places of the scope in the board's frame, mm.
struct BoardSight {
  double at_s = 0;                                      ///< the frame's stamp (mid-exposure)
  Eigen::Vector3d marker_mm = Eigen::Vector3d::Zero();  ///< origin of S, through the hand-eye pose
  Eigen::Vector3d camera_mm = Eigen::Vector3d::Zero();  ///< origin of C
};

/// A feature of the scene followed from frame to frame: where it was seen, as x/z and y/z in C.
struct FeatureSight {
  std::size_t frame = 0;  ///< index into ImageMotion::frames_at_s
  Eigen::Vector2d flat = Eigen::Vector2d::Zero();
};
using FeaturePath = std::vector<FeatureSight>;

/// Either a board's sights, or features' paths with the frames' stamps.
struct ImageMotion {
  std::vector<BoardSight> board;
  std::vector<FeaturePath> features;
  std::vector<double> frames_at_s;
};

struct LagSettings {
  double search_s = 0.25;  ///< lags from minus to plus this are tried
  double step_s = 0.004;
  Pose<S, C> X_SC;  ///< hand-eye
  std::size_t fewest_movements = 5;
  double widest_s = 0.003;       ///< an interval with a larger half width is refused
  double least_explained = 0.5;  ///< part of the image's motion that the tracker's must explain
  int draws = 2000;              ///< of the bootstrap
  unsigned seed = 1;
};

/// One movement of the scope: what it says by itself.
struct MovementLag {
  double from_s = 0, to_s = 0;  ///< by the tracker's stamps
  std::size_t samples = 0;      ///< frames
  double lag_s = 0;             ///< where its own misfit is least
  double misfit = 0;            ///< RMS there: mm (board) or rad (features)
};

/// The lag is what is to be added to a frame's stamp before the tracker is asked: [sync]
/// tracker_against_video. A video that is stamped late has a negative one.
struct LagFit {
  double lag_s = 0;
  double half_width_s = 0;  ///< of the 95 % interval
  /// Standard deviation of a Gaussian with that interval.
  double deviation_s() const { return half_width_s / 1.959964; }
  double explained = 0;  ///< 1 - misfit / motion, in squares
  std::vector<MovementLag> movements;
  std::vector<double> lags_s, misfits;  ///< the curve: RMS over all movements against the lag
};

/// Stretches in which the marker moves: faster than a fifth of its swift pace (95th percentile), and 2 mm/s,
/// at least 0.2 s long and 5 mm far (rotation counted at 100 mm). Cut where longer than 2.5 s.
struct Stretch_s {
  double from_s = 0, to_s = 0;
};
std::vector<Stretch_s> find_movements(const PoseTrack& track);

/// Least squares over all movements for each lag: the board's sights against the marker's places by a rigid
/// transform of each movement's own (Horn 1987); each feature's directions against the one place at rest that
/// explains them best from where the camera was. The interval: movements drawn again with replacement, the
/// spread of the answer widened to Student's t for as many movements.
///
/// Refuses too few movements, motion that the tracker does not explain, a best lag at the end of the search,
/// two lags that explain alike, and an interval that is too wide; each with what to do.
Result<LagFit> fit_lag(const PoseTrack& track, const ImageMotion& motion, const LagSettings& settings);

}  // namespace orcart
