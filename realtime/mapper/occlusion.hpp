// Whether a triangle is hidden from the scope: a few rays, each vertex traced once a view.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

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
  /// True when all three corners and the centroid lie behind something. One sample in sight keeps the
  /// triangle: what is hidden of it is the painter's to find, texel by texel.
  bool hidden(const RayScene& surface, const std::array<std::uint32_t, 3>& vertices,
              const std::array<Eigen::Vector3f, 3>& corners_mm) noexcept;
  /// Rays traced since begin().
  std::uint32_t rays() const noexcept { return rays_; }

 private:
  bool vertex_hidden(const RayScene& surface, std::uint32_t vertex, const Eigen::Vector3f& at_mm) noexcept;

  std::vector<std::uint32_t> seen_at_;  ///< 2 * view, plus 1 where hidden
  std::uint32_t view_ = 0;
  std::uint32_t rays_ = 0;
  Eigen::Vector3f apex_mm_ = Eigen::Vector3f::Zero();
};

}  // namespace orcart
