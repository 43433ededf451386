// Cuts a surface into charts: connected patches that lie flat without overlapping themselves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// A patch projected along its own normal. Corner positions are in texels, the lowest one within
/// texel (0,0).
struct Chart {
  std::vector<std::uint32_t> triangles;
  std::vector<std::array<Eigen::Vector2f, 3>> corners_texels;
  Eigen::Vector2f size_texels = Eigen::Vector2f::Zero();
};

/// Grown from the lowest triangle number not yet taken, over neighbours whose normal is within about 50
/// degrees of the start's, as long as they cover no texel twice and the chart stays within kChartSizeTexels.
/// Deterministic.
inline constexpr int kChartSizeTexels = 160;
std::vector<Chart> grow_charts(const TriangleMesh& mesh, double texel_mm);

}  // namespace orcart
