// Chooses the lens model; the pinhole part and the limits of angle are common to all three.
#include "realtime/optics/lens.hpp"

#include <cmath>
#include <numbers>

#include "realtime/optics/lens_models.hpp"

namespace orcart {
namespace {

/// What a round trip may lose at the very edge of the lens.
constexpr double kAngleTolerance_rad = 1e-9;

double angle_off_axis_rad(const Eigen::Vector3d& p) {
  return std::atan2(std::hypot(p.x(), p.y()), p.z());
}

bool seen(const Lens& lens, const Eigen::Vector3d& p) {
  return p.z() > 0 && angle_off_axis_rad(p) <= lens.max_angle_rad + kAngleTolerance_rad;
}

}  // namespace

std::optional<Eigen::Vector2d> project(const Lens& lens, const Eigen::Vector3d& p_C_mm) {
  if (!seen(lens, p_C_mm)) return std::nullopt;
  switch (lens.model) {
    case LensModel::brown:
      return brown::project(lens, p_C_mm);
    case LensModel::poly4:
      return poly4::project(lens, p_C_mm);
    case LensModel::fisheye:
      return fisheye::project(lens, p_C_mm);
  }
  return std::nullopt;
}

std::optional<Eigen::Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel) {
  std::optional<Eigen::Vector3d> direction;
  switch (lens.model) {
    case LensModel::brown:
      direction = brown::direction_of(lens, pixel);
      break;
    case LensModel::poly4:
      direction = poly4::direction_of(lens, pixel);
      break;
    case LensModel::fisheye:
      direction = fisheye::direction_of(lens, pixel);
      break;
  }
  if (!direction || !seen(lens, *direction)) return std::nullopt;
  return direction->normalized();
}

double largest_monotone_angle_rad(const Lens& lens, double limit_rad) {
  switch (lens.model) {
    case LensModel::brown:
      return brown::largest_monotone_angle_rad(lens, limit_rad);
    case LensModel::poly4:
      return poly4::largest_monotone_angle_rad(lens, limit_rad);
    case LensModel::fisheye:
      return fisheye::largest_monotone_angle_rad(lens, limit_rad);
  }
  return 0;
}

}  // namespace orcart
