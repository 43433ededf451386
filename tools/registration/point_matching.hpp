// Which fiducial is which, where nobody has kept the order: by the distances between them.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "realtime/base/result.hpp"

namespace orcart {

/// For each fixed point the index of its moving partner. Moving points may be more than the fixed ones. The
/// answer is the assignment of least FRE among those whose distances agree within `tolerance_mm`. Refuses
/// where none does, or where a second one of another order fits as well (a set that looks the same from two
/// sides).
Result<std::vector<std::size_t>> match_points(const std::vector<Eigen::Vector3d>& fixed_mm,
                                              const std::vector<Eigen::Vector3d>& moving_mm,
                                              double tolerance_mm);

}  // namespace orcart
