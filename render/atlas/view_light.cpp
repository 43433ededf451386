// Every n-th triangle, at its middle.
#include "render/atlas/view_light.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace orcart {
namespace {
constexpr std::size_t kSamples = 400;
constexpr float kDisplayPower = 2.2F;
}  // namespace

float light_at(const LitPoint& point, const FallOff& fall_off) noexcept {
  const float nearness = static_cast<float>(fall_off.reference_mm) / point.distance_mm;
  return nearness * nearness *
         std::pow(point.axis_cosine, static_cast<float>(fall_off.vignetting_cos_power)) *
         (point.angle_cosine + 0.2F) / 1.2F;
}

void ViewLight::begin(const Pose<M, C>& X_MC, const ScopeModel& scope) noexcept {
  tip_mm_ = X_MC.translation_mm.cast<float>();
  axis_ = X_MC.rotation.col(2).cast<float>();
  fall_off_ = scope.fall_off;
  cone_cosine_ = static_cast<float>(std::cos(scope.cone_half_angle_rad));
  sum_ = weight_ = 0;
}

void ViewLight::add(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) noexcept {
  const std::size_t step = std::max<std::size_t>(1, triangles.size() / kSamples);
  for (std::size_t i = 0; i < triangles.size(); i += step) {
    const auto& corners = mesh.triangles[triangles[i]];
    const Eigen::Vector3f &a = mesh.vertices_mm[corners[0]], &b = mesh.vertices_mm[corners[1]],
                          &c = mesh.vertices_mm[corners[2]];
    const Eigen::Vector3f ray = (a + b + c) / 3 - tip_mm_, doubled_area = (b - a).cross(c - a);
    const float distance_mm = ray.norm(), seen_area = std::abs(doubled_area.dot(ray)) / distance_mm;
    const float axis_cosine = ray.dot(axis_) / distance_mm;
    if (!(seen_area > 0) || !(axis_cosine > cone_cosine_)) continue;
    const LitPoint point{distance_mm, axis_cosine, seen_area / doubled_area.norm()};
    const double weight = static_cast<double>(step) * seen_area / (distance_mm * distance_mm);
    sum_ += weight * std::pow(light_at(point, fall_off_), 1 / kDisplayPower);
    weight_ += weight;
  }
}

float ViewLight::mean() const noexcept {
  return weight_ > 0 ? static_cast<float>(std::pow(sum_ / weight_, kDisplayPower)) : 1.0F;
}

}  // namespace orcart
