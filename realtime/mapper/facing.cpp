// Facing by the sign of a volume; obliquity by the triangle's point nearest to the apex, where it is least.
#include "realtime/mapper/facing.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace orcart {
namespace {

/// Squared distance of the origin from a segment.
double squared_distance_to_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0;
  return (a + t * along).squaredNorm();
}

/// Squared distance of the origin from a triangle with normal n (not zero).
double squared_distance(const std::array<Eigen::Vector3d, 3>& p, const Eigen::Vector3d& n) {
  bool above = true;
  double nearest2 = p[0].squaredNorm();
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &a = p[i], &b = p[(i + 1) % 3];
    above = above && n.cross(b - a).dot(-a) >= 0;
    nearest2 = std::min(nearest2, squared_distance_to_segment(a, b));
  }
  const double height = n.dot(p[0]);
  return above ? height * height / n.squaredNorm() : nearest2;
}

}  // namespace

Facing facing_of(const std::array<Eigen::Vector3f, 3>& corners_mm, const Eigen::Vector3f& apex_mm,
                 SeenFrom seen_from, double cos_max_obliquity) noexcept {
  const Eigen::Vector3d apex = apex_mm.cast<double>();
  std::array<Eigen::Vector3d, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = corners_mm[i].cast<double>() - apex;
  const Eigen::Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]);
  const double towards = seen_from == SeenFrom::outside ? -n.dot(p[0]) : n.dot(p[0]);
  if (!(towards > 0)) return Facing::back;
  // cos(obliquity) at a point q is towards / (|n| |q|): greatest where q is nearest.
  const double reach2 = towards * towards / (n.squaredNorm() * cos_max_obliquity * cos_max_obliquity);
  for (const Eigen::Vector3d& corner : p)
    if (corner.squaredNorm() <= reach2) return Facing::front;
  return squared_distance(p, n) <= reach2 ? Facing::front : Facing::steep;
}

}  // namespace orcart
