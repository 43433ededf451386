// The products of a cutout: triangles with texture coordinates, or ranges of the tree's triangles; slots that
// are allocated before arming.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "realtime/mapper/cutout_patch.hpp"

namespace orcart {

/// Which triangles a cutout takes.
enum class CutoutRule : std::uint8_t {
  touching,  ///< every triangle that shares a point with the cone: none is missed, however large
  corner,    ///< those with a corner in the cone, as VTK's filters choose
};

/// A mesh of its own: corners index the vertices beside it. Capacity is reserved once; the vectors keep their
/// size, the counts say what is valid.
struct CutoutMesh {
  std::vector<float> x_mm, y_mm, z_mm;                ///< in M
  std::vector<float> s, t;                            ///< the paper's texture coordinates (PaperProjection)
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< as the surface turns them
  std::uint32_t vertices = 0, triangles = 0;
  std::uint32_t with_corner = 0;  ///< of the surface's triangles: those with a corner in the cone
  std::uint32_t uncut =
      0;  ///< form clip: whole triangles, since the cone's surface meets none of their edges
  FiveRays rays;
  PaperProjection paper;  ///< not valid: the centre ray missed, and there is no triangle
  bool first_part = true;
  bool last_part = true;  ///< false: a cap was reached; the next part goes on there

  /// Room for so many triangles, and three times as many vertices. At least what one clipped cluster takes.
  explicit CutoutMesh(std::size_t max_triangles);
};

/// Triangles [first, first + count) in the order of ClusterTree::triangle_ids().
struct TriangleRange {
  std::uint32_t first = 0, count = 0;
};

/// Clusters that meet the cone, as ranges in the tree's order, neighbours joined. The shader projects:
/// texture coordinates and rays are not needed. A range may reach out of the cone by a cluster's size.
struct CutoutRanges {
  std::vector<TriangleRange> ranges;  ///< as CutoutMesh: `count` of them are valid
  std::uint32_t count = 0, triangles = 0;
  std::vector<std::uint64_t> hit;  ///< scratch: a bit a cluster

  explicit CutoutRanges(std::size_t cluster_count) : ranges(cluster_count), hit(cluster_count / 64 + 1) {}
};

}  // namespace orcart
