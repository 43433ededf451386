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
#include "realtime/geometry/viewing_cone.hpp"

namespace orcart {

/// Built off the real-time path, then immutable; any thread may read. Flat arrays, coordinates apart (x, y,
/// z), so that a loop over a cluster's vertices or a node's eight spheres is straight-line vector work. About
/// 20 bytes a triangle on a closed mesh.
class ClusterTree {
 public:
  static constexpr std::size_t kMaxTriangles = 48;                ///< in a cluster
  static constexpr std::size_t kMaxVertices = 3 * kMaxTriangles;  ///< so that a corner fits in 8 bits
  static constexpr std::size_t kWidth = 8;                        ///< children of a node
  /// Splits halve, to a multiple of 48; three make a level: 2^32 triangles need at most 10 levels, and a walk
  /// that pops one entry and pushes eight never holds more than 7 levels + 1.
  static constexpr std::size_t kMaxLevels = 12;
  static constexpr std::size_t kMaxStack = 7 * kMaxLevels + 1;

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
    std::array<std::uint32_t, kWidth> child;    ///< a node, or with kLeaf set a cluster
  };
  static constexpr std::uint32_t kLeaf = 1U << 31;

  static Result<ClusterTree> create(const TriangleMesh& mesh);

  Cluster cluster(std::uint32_t index) const noexcept;
  std::size_t cluster_count() const noexcept { return parts_.size() - 1; }
  std::span<const Node> nodes() const noexcept { return nodes_; }
  /// Of all arrays together.
  std::size_t bytes() const noexcept;

 private:
  friend class ClusterTreeBuilder;
  /// Where a cluster's entries start; one more part than clusters marks the end.
  struct Part {
    std::uint32_t first_vertex = 0, first_triangle = 0;
  };
  std::vector<float> x_, y_, z_;
  std::vector<std::uint32_t> vertex_ids_, triangle_ids_;
  std::vector<std::array<std::uint8_t, 3>> corners_;
  std::vector<Part> parts_;
  std::vector<Node> nodes_;
};

/// A cluster that the cone may meet.
struct ClusterVisit {
  std::uint32_t cluster = 0;
  bool inside = false;  ///< all of it lies inside the cone: its triangles need no test
};

/// A walk through the tree that stops at each cluster and can be taken up later. Real-time: allocates
/// nothing, visits each node at most once, keeps its stack in itself.
/// Of a node's children the nearest comes first: what hides tends to come before what it hides.
class ConeWalk {
 public:
  void begin(const ClusterTree& tree) noexcept;
  /// The next cluster, or false when there are no more. The same tree and cone until the walk ends.
  bool next(const ClusterTree& tree, const ViewingCone& cone, ClusterVisit& visit) noexcept;

 private:
  void push_children(const ClusterTree::Node& node, const ViewingCone& cone, bool inside) noexcept;

  struct Entry {
    float depth_mm = 0;
    std::uint32_t child = 0;
  };
  std::array<Entry, ClusterTree::kMaxStack> stack_{};
  std::size_t size_ = 0;
};

}  // namespace orcart
