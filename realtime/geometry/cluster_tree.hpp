// The surface in clusters of neighbouring triangles under a wide tree of spheres: what the viewing cone
// walks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// Built off the real-time path, then immutable; any thread may read. Flat arrays, coordinates apart (x, y,
/// z), so that a loop over a cluster's vertices or a node's eight spheres is straight-line vector work. About
/// 20 bytes a triangle on a closed mesh. Clusters and their triangles lie in the order of the tree's leaves,
/// so that a subtree is one range of both.
class ClusterTree {
 public:
  static constexpr std::size_t kMaxTriangles = 48;  ///< in a cluster; all but the last hold as many
  static constexpr std::size_t kMaxVertices = 3 * kMaxTriangles;  ///< so that a corner fits in 8 bits
  static constexpr std::size_t kWidth = 8;                        ///< children of a node
  /// A level holds eight times the clusters of the one below: 2^30 triangles need 9.
  static constexpr std::size_t kMaxLevels = 12;
  /// So much may be read beyond the end of each array (elements), and beyond a cluster's part of it: a loop
  /// over whole vectors needs no remainder.
  static constexpr std::size_t kPadding = 64;

  /// One cluster as the arrays it owns a part of.
  struct Cluster {
    std::span<const float> x, y, z;                        ///< vertices, mm, in M
    std::span<const std::uint32_t> vertex_ids;             ///< of the mesh, beside x, y, z
    std::span<const std::array<std::uint8_t, 3>> corners;  ///< of each triangle, as indices into x, y, z
    std::span<const std::uint32_t> triangle_ids;           ///< of the mesh, beside corners
  };

  /// Eight spheres and what is in them. Unused places have a radius that meets nothing.
  struct Node {
    std::array<float, kWidth> x, y, z, radius;  ///< mm, in M; the radius already holds a margin for rounding
    std::array<std::uint32_t, kWidth> child;    ///< a node, where a place holds more than one cluster
    std::array<std::uint32_t, kWidth + 1> cluster;  ///< place i holds the clusters from [i] up to [i + 1]
  };

  static Result<ClusterTree> create(const TriangleMesh& mesh);

  Cluster cluster(std::uint32_t index) const noexcept;
  std::size_t cluster_count() const noexcept { return first_vertex_.size() - 1; }
  std::size_t triangle_count() const noexcept { return triangle_count_; }
  std::span<const Node> nodes() const noexcept { return nodes_; }
  /// The mesh's triangles in the tree's order: cluster i's begin at i * kMaxTriangles.
  std::span<const std::uint32_t> triangle_ids() const noexcept {
    return {triangle_ids_.data(), triangle_count_};
  }
  /// Of all arrays together.
  std::size_t bytes() const noexcept;

  /// The arrays bare, for vector code.
  struct Arrays {
    const float *x, *y, *z;
    const std::uint32_t* first_vertex;  ///< of each cluster, and one more that marks the end
    const std::uint8_t* corners;        ///< three a triangle
    const Node* nodes;
    std::uint32_t triangle_count;
  };
  Arrays arrays() const noexcept {
    return {.x = x_.data(),
            .y = y_.data(),
            .z = z_.data(),
            .first_vertex = first_vertex_.data(),
            .corners = corners_.data()->data(),
            .nodes = nodes_.data(),
            .triangle_count = triangle_count_};
  }

 private:
  friend class ClusterTreeBuilder;
  std::vector<float> x_, y_, z_;
  std::vector<std::uint32_t> vertex_ids_, triangle_ids_;
  std::vector<std::array<std::uint8_t, 3>> corners_;
  std::vector<std::uint32_t> first_vertex_;
  std::vector<Node> nodes_;
  std::uint32_t triangle_count_ = 0;
};

}  // namespace orcart
