// Where the board stands before the camera, through a lens that is known.
#pragma once

#include "tools/calibration/camera_solver.hpp"

namespace orcart {

/// The board's pose for one view. Refuses a view with too few corners, with its name.
Result<Pose<C, B>> board_pose(const BoardView& view, const Lens& lens);

/// The numbers of quarter turns after which a board looks the same; 0 comes first.
std::vector<int> turns_alike(Anchor anchor);

/// X_BB' of a board that is turned about its middle by quarter turns: places p' that were counted on it lie
/// at X_BB' p'.
Pose<B, B> turned_about_middle(const Pattern& pattern, int quarter_turns);

/// Numbers that come from coloured dots and numbers that come from the board's corners are of two kinds:
/// where some views have the dots, those without become Anchor::none and say so.
void keep_one_numbering(std::vector<BoardView>& views);

}  // namespace orcart
