// The cutout's inner loops behind run-time dispatch: what they take and what room they need.
#pragma once

#include <cstddef>

#include "realtime/mapper/cutout.hpp"

namespace orcart {

constexpr std::size_t kClippedClusterTriangles = 4 * ClusterTree::kMaxTriangles;  ///< a hexagon is four
constexpr std::size_t kClippedClusterVertices = ClusterTree::kMaxVertices + 6 * ClusterTree::kMaxTriangles;
constexpr std::size_t kEmitPadding = 64;  ///< whole vectors are written

/// Appends triangles until the walk ends (true) or the next cluster could exceed the mesh's room (false).
bool emit_cutout(const ClusterTree& tree, CutoutProgress& progress, CutoutMesh& mesh) noexcept;
void collect_ranges(const ClusterTree& tree, ConeWalk& walk, CutoutRanges& ranges) noexcept;

}  // namespace orcart
