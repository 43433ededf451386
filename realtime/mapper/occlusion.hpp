// Which triangles of a cluster are hidden from the scope: a few rays, each vertex traced once a view.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "realtime/geometry/cluster_tree.hpp"
#include "realtime/geometry/ray_scene.hpp"

namespace orcart {

/// Remembers per vertex what the ray to it said in this view. Built off the real-time path; the rest is
/// real-time.
class Occlusion {
 public:
  /// A triangle costs at most this many rays: three corners and the centroid.
  static constexpr std::uint32_t kMaxRays = 4;

  explicit Occlusion(std::size_t vertex_count) : seen_at_(vertex_count, 0) {}

  /// Forgets the view before. All of the memory is touched only once in 2^31 views.
  void begin(const Eigen::Vector3f& apex_mm) noexcept;
  /// Of the triangles whose bit is set in `which`, those with all three corners and the centroid behind
  /// something. One sample in sight keeps a triangle: what is hidden of it is the painter's to find, texel by
  /// texel. Rays to neighbours are traced together.
  std::uint64_t hidden(const RayScene& surface, const ClusterTree::Cluster& cluster,
                       std::uint64_t which) noexcept;
  /// Rays traced since begin().
  std::uint32_t rays() const noexcept { return rays_; }

 private:
  void trace_vertices(const RayScene& surface, const ClusterTree::Cluster& cluster,
                      std::uint64_t which) noexcept;
  void trace(const RayScene& surface, std::size_t count) noexcept;

  std::vector<std::uint32_t> seen_at_;  ///< 2 * view, plus 1 where hidden
  std::uint32_t view_ = 0;
  std::uint32_t rays_ = 0;
  Eigen::Vector3f apex_mm_ = Eigen::Vector3f::Zero();
  // Scratch: the points of one batch, whose they are, and the answers.
  std::array<Eigen::Vector3f, ClusterTree::kMaxVertices> point_mm_{};
  std::array<std::uint32_t, ClusterTree::kMaxVertices> owner_{};
  std::array<std::uint8_t, ClusterTree::kMaxVertices> hidden_{};
};

}  // namespace orcart
