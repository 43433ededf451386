// The paper's tip error on a recorded view of a board: where tracker and hand-eye put the tip, against where
// the picture does.
#pragma once

#include <vector>

#include "tools/calibration/board_pose.hpp"
#include "tools/calibration/board_view.hpp"

namespace orcart {

/// One view that took no part in hand-eye and board's place.
struct TipPlaces {
  Pose<B, C> believed;  ///< by tracker, hand-eye and the board's place
  Pose<C, B> seen;      ///< by the picture's own corners, which are printed at known places
  Pose<C, E> X_CE;      ///< to the window; identity where the passport has none: the tip is then C
};

struct TipErrors {
  /// Of each corner the view sees, the size of: its distance from the believed tip, less the one from where
  /// the picture puts the tip.
  std::vector<double> distances_mm;
  double apart_mm = 0;    ///< of the two tips, in 3-D
  double along_mm = 0;    ///< the difference along the optical axis to the board, as `calibrate tip` counts
  double picture_mm = 0;  ///< what the picture itself leaves open about its tip: RMS in 3-D
};

/// `corner_sigma_px`: a corner's standard deviation, as many alike as count as one. Refuses a board seen edge
/// on.
Result<TipErrors> tip_errors(const TipPlaces& places, const BoardView& view, const Lens& lens,
                             double corner_sigma_px);

}  // namespace orcart
