// Where the camera sits on its marker: closed form, then lens, hand-eye and board together with the tracker's
// noise.
#pragma once

#include <vector>

#include "tools/calibration/camera_solver.hpp"
#include "tools/registration/poses_file.hpp"

namespace orcart {

struct TrackerNoise {
  double marker_mm = 0.25;                              ///< standard deviation of one marker's place
  double body_radius_mm = 40;                           ///< of the four markers about their middle
  double position_mm() const { return marker_mm / 2; }  ///< of the body: mean of four markers
  double turn_rad() const { return marker_mm / (1.41 * body_radius_mm); }  ///< of the body about one axis
};

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
};

/// Park and Martin 1994 for the rotation, least squares for the translation; all pairs of views. Refuses
/// fewer than three views and motions that turn about one axis only.
Result<HandEyeFit> hand_eye_closed_form(const std::vector<HandEyeView>& views);

/// Starts from the closed form; board poses and, where `refine_lens`, the lens move along with the hand-eye
/// pose.
enum class LensRole { held, refined };
Result<HandEyeFit> refine_hand_eye(const std::vector<HandEyeView>& views, const Lens& lens,
                                   const TrackerNoise& noise, LensRole role);

/// The board's origin seen by each view, against the one that all other views place: RMS, mm.
Result<double> leave_one_out_mm(const std::vector<HandEyeView>& views, const Lens& lens,
                                const TrackerNoise& noise, LensRole role);

/// Boards that look the same upside down are turned so that all views agree with the motion of the marker.
void settle_half_turns(std::vector<HandEyeView>& views, const Pattern& pattern);

/// RMS distance of the board's origins from their mean for given hand-eye pose; fills `each`.
double scatter_mm(const std::vector<HandEyeView>& views, const Pose<S, C>& X_SC, std::vector<double>& each);

}  // namespace orcart
