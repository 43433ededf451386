// The three models of distortion, one namespace each; lens.hpp chooses between them and checks angles.
#pragma once

#include <optional>

#include "realtime/optics/lens.hpp"

namespace orcart {

/// In each: `project` expects a point in front of the camera and within lens.max_angle_rad; `direction_of`
/// answers without unit length, and nothing where no direction of the monotone part lands on the pixel.

namespace brown {
Eigen::Vector2d project(const Lens& lens, const Eigen::Vector3d& p_C_mm);
std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel);
double largest_monotone_angle_rad(const Lens& lens, double limit_rad);
}  // namespace brown

namespace poly4 {
Eigen::Vector2d project(const Lens& lens, const Eigen::Vector3d& p_C_mm);
std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel);
double largest_monotone_angle_rad(const Lens& lens, double limit_rad);
}  // namespace poly4

namespace fisheye {
Eigen::Vector2d project(const Lens& lens, const Eigen::Vector3d& p_C_mm);
std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel);
double largest_monotone_angle_rad(const Lens& lens, double limit_rad);
}  // namespace fisheye

}  // namespace orcart
