// Directions spread evenly, for asking all around a point or within a cone.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

namespace orcart {

/// `count` unit directions within `half_angle_rad` of `axis`, on a Fibonacci spiral (Gonzalez 2010): equal
/// solid angles.
inline std::vector<Eigen::Vector3f> spiral_directions(const Eigen::Vector3f& axis, double half_angle_rad,
                                                      int count) {
  const Eigen::Quaternionf turn = Eigen::Quaternionf::FromTwoVectors(Eigen::Vector3f::UnitZ(), axis);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (1 - std::cos(half_angle_rad)) * (i + 0.5) / count;
    const double radius = std::sqrt(std::max(0.0, 1 - z * z)), around = golden * i;
    directions.emplace_back(
        turn * Eigen::Vector3d(radius * std::cos(around), radius * std::sin(around), z).cast<float>());
  }
  return directions;
}

}  // namespace orcart
