// How bright a view is on the whole: what a camera that exposes by itself has made into its middle grey.
#pragma once

#include <cstdint>
#include <vector>

#include "realtime/geometry/pose.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// The light of shaders/light.glsl at one point: distance (mm), cosine off the axis, cosine of the incidence.
struct LitPoint {
  float distance_mm = 1, axis_cosine = 1, angle_cosine = 1;
};
float light_at(const LitPoint& point, const FallOff& fall_off) noexcept;

/// Means over the triangles of a view, each by the part of the picture that it fills; brightness as it is
/// displayed (power 1 / 2.2), which is what cameras meter. A few hundred triangles stand for all. Real-time.
class ViewLight {
 public:
  void begin(const Pose<M, C>& X_MC, const ScopeModel& scope) noexcept;
  void add(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) noexcept;
  /// 1 where nothing was added.
  float mean() const noexcept;

 private:
  Eigen::Vector3f tip_mm_ = Eigen::Vector3f::Zero(), axis_ = Eigen::Vector3f::UnitZ();
  FallOff fall_off_;
  float cone_cosine_ = 0;
  double sum_ = 0, weight_ = 0;
};

}  // namespace orcart
