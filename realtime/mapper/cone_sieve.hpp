// Tells for each triangle of one cluster whether it meets the viewing cone.
#pragma once

#include <array>
#include <cstdint>

#include "realtime/geometry/cluster_tree.hpp"

namespace orcart {

/// Scratch for one cluster after another; lives with its owner, allocates nothing.
class ConeSieve {
 public:
  /// Brings the cluster's vertices to C and notes for each where it lies about the cone.
  void load(const ClusterTree::Cluster& cluster, const ViewingCone& cone) noexcept;
  /// Exact (meets_cone); most triangles are decided by their corners' notes alone.
  bool meets(const std::array<std::uint8_t, 3>& corners, const ViewingCone& cone) const noexcept;

 private:
  std::array<float, ClusterTree::kMaxVertices> x_{}, y_{}, z_{};  ///< in C, mm
  /// Bit 0: inside the cone. Other bits: beyond one of the planes that bound the cone; three corners beyond
  /// one plane, and the triangle is out.
  std::array<std::uint16_t, ClusterTree::kMaxVertices> notes_{};
};

}  // namespace orcart
