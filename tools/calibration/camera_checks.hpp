// Whether a set of views can calibrate a camera: before solving, after it, and what view to add.
#pragma once

#include <string>
#include <vector>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/camera_solver.hpp"

namespace orcart {

/// One file read: sizes must agree and no two views may be the same. Views without corners are let through.
Result<void> check_views(const std::vector<BoardView>& views, const Pattern& pattern);

/// Refuses what leaves the focal length open: no tilt, one distance, or a focal length known worse than to a
/// tenth.
Result<void> check_fit(const CameraFit& fit, const CameraTask& task);

/// Part of the mask, 0..1, that corners cover: cells of an 8 by 8 grid.
double coverage(const std::vector<BoardView>& views, const CircularMask& mask, double aspect);

/// Sentences on which views would help most.
std::vector<std::string> hints(const std::vector<BoardView>& views, const CameraFit& fit, double covered);

}  // namespace orcart
