// Where the camera sits on its marker: closed form, then lens, hand-eye and board together with the tracker's
// noise.
#pragma once

#include <optional>
#include <vector>

#include "realtime/geometry/twist.hpp"
#include "tools/calibration/camera_solver.hpp"
#include "tools/calibration/tracker_noise.hpp"
#include "tools/registration/poses_file.hpp"

namespace orcart {

/// One view: the marker's pose, and what the camera saw.
struct HandEyeView {
  Pose<T, S> X_TS;
  Pose<C, B> X_CB;
  BoardView board;
};

struct HandEyeFit {
  Pose<S, C> X_SC;
  Pose<T, B> X_TB;
  Lens lens;
  std::vector<Pose<C, B>> X_CB;  ///< refined, in the order of the views
  double scatter_mm = 0;  ///< RMS distance of the board's origins, each through its own view, from their mean
  std::vector<double> scatters_mm;  ///< of each view
  double rms_px = 0;
  double corner_sigma_px = 0;  ///< what a corner was weighed by in the refinement
};

/// Park and Martin 1994 for the rotation, least squares for the translation; all pairs of views. Refuses
/// fewer than three views and motions that turn about one axis only.
Result<HandEyeFit> hand_eye_closed_form(const std::vector<HandEyeView>& views);

enum class LensRole { held, refined };
struct RefineTask {
  TrackerNoise noise;
  LensRole role = LensRole::refined;
  /// How many corners count as one. What is left over in a view is mostly the lens model's misfit, alike in
  /// neighbouring corners: taken for independent they would tell the board's pose far too surely.
  double corners_alike = 1;
};

/// Starts from the closed form; board poses and, where it is refined, the lens move along with the hand-eye
/// pose.
Result<HandEyeFit> refine_hand_eye(const std::vector<HandEyeView>& views, const Lens& lens,
                                   const RefineTask& task);

/// What the views leave open about a refined fit.
struct HandEyeSpread {
  TwistCovariance hand_eye;            ///< of X_SC: a twist in C (mm, rad)
  std::optional<LensCovariance> lens;  ///< where it was refined, in Lens's units
  double misfit = 0;   ///< sum of the markers' whitened squares over their degrees of freedom: 1 where the
                       ///< noise is as declared. hand_eye is multiplied by it
  double freedom = 0;  ///< those degrees
};

/// First order at the fit, scaled by the markers' misfit and, since that is itself known from few views only,
/// widened as the covariance of Student's t. Nothing where the views leave a number open. With the lens held,
/// its own error is not in it.
std::optional<HandEyeSpread> hand_eye_spread(const std::vector<HandEyeView>& views, const HandEyeFit& fit,
                                             const RefineTask& task);

/// The board's origin seen by each view, through the lens and hand-eye pose of all others, against where they
/// place it: RMS, mm. `each`, where given, takes the distances.
Result<double> leave_one_out_mm(const std::vector<HandEyeView>& views, const Lens& lens,
                                const RefineTask& task, std::vector<double>* each = nullptr);

/// The least that any one hand-eye pose could make of leave_one_out_mm with these board poses, were it fitted
/// to just that and to all views (mm): where it is large, the marker's poses and the camera's turn
/// differently, and no calibration helps.
double least_left_out_mm(const std::vector<HandEyeView>& views, const Pose<S, C>& start);

/// How many corners count as one: the sum of the residuals' correlations over three squares around a corner.
double corners_alike(const std::vector<HandEyeView>& views, const Lens& lens);

/// RMS distance by which the tracker's noise alone throws the board's origin, seen through one view.
double tracker_floor_mm(const std::vector<HandEyeView>& views, const HandEyeFit& fit,
                        const TrackerNoise& noise);

/// Boards that look the same upside down, or on their sides, are turned so that all views agree with the
/// motion of the marker.
void settle_turns(std::vector<HandEyeView>& views, const Pattern& pattern);

/// RMS distance of the board's origins from their mean for given hand-eye pose; fills `each`.
double scatter_mm(const std::vector<HandEyeView>& views, const Pose<S, C>& X_SC, std::vector<double>& each);

}  // namespace orcart
