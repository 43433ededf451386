// Which steps of a lattice of dots are its sides.
#pragma once

#include <opencv2/core.hpp>

#include "tools/calibration/lattice.hpp"

namespace orcart {

/// A tilted grid's diagonal may look shorter than its sides, and a lattice that took it for one is as regular
/// as the right one. Counts along the sides again where that makes squares; `picture` is the picture's size,
/// whose middle is taken for the lens's.
void count_along_sides(Lattice& lattice, const cv::Size& picture);

}  // namespace orcart
