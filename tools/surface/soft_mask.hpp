// A region of a volume as a smooth field: 1 inside, 0 outside, its surface at 0.5.
#pragma once

#include <array>
#include <vector>

namespace orcart {

/// Three coordinates in LPS, millimetres. Plain, since ITK brings an Eigen of its own that clashes with ours.
using PlainPoint = std::array<double, 3>;

/// values[i + size[0] * (j + size[1] * k)] belongs to origin_mm + i step_mm[0] + j step_mm[1] + k step_mm[2],
/// LPS. The outermost layer is 0, so that a surface of it is closed.
struct SoftMask {
  std::array<int, 3> size{};
  std::vector<float> values;
  PlainPoint origin_mm{};
  std::array<PlainPoint, 3> step_mm{};
};

}  // namespace orcart
