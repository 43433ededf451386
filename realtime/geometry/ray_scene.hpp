// Rays against a surface: nearest hit and occlusion, through Embree. Exact triangles, watertight.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

struct RayHit {
  float distance_mm = 0;  ///< along the unit direction
  std::uint32_t triangle = 0;
  float b1 = 0, b2 = 0;  ///< barycentric weights of corners 1 and 2
};

/// Built off the real-time path; queries are real-time: they allocate nothing, and any number of threads may
/// ask.
class RayScene {
 public:
  static Result<RayScene> create(const TriangleMesh& mesh);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// The nearest triangle from either side along a unit direction, between near_mm and far_mm.
  std::optional<RayHit> nearest(const Eigen::Vector3f& origin_mm, const Eigen::Vector3f& direction,
                                float far_mm, float near_mm = 0) const noexcept;
  /// Whether something lies between `origin` and a point of the surface; the last margin_mm before the point
  /// are left out, so that the point's own triangle does not hide it.
  bool hidden(const Eigen::Vector3f& origin_mm, const Eigen::Vector3f& point_mm,
              float margin_mm) const noexcept;
  /// The same for many points from one origin, neighbours together: hidden[i] is 1 or 0.
  void hidden_many(const Eigen::Vector3f& origin_mm, std::span<const Eigen::Vector3f> points_mm,
                   float margin_mm, std::span<std::uint8_t> hidden) const noexcept;
  /// Nearest hits for many directions from one origin (unit, any order): hits[i].distance_mm < 0 where
  /// missed.
  void nearest_many(const Eigen::Vector3f& origin_mm, std::span<const Eigen::Vector3f> directions,
                    float far_mm, std::span<RayHit> hits) const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
  explicit RayScene(std::unique_ptr<State> state);
};

}  // namespace orcart
