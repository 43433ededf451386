// Where the board stands before the camera, through a lens that is known.
#pragma once

#include "tools/calibration/camera_solver.hpp"

namespace orcart {

/// The board's pose for one view. Refuses a view with too few corners, with its name.
Result<Pose<C, B>> board_pose(const BoardView& view, const Lens& lens);

}  // namespace orcart
