// The exact test of a triangle against the viewing cone, in double precision.
#include "realtime/geometry/viewing_cone.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {
namespace {

using Segment = std::array<Eigen::Vector3d, 2>;

double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether some point of a segment has z tangent - rho >= 0. That depth is concave along the segment, so its
/// greatest value lies where its derivative is zero or at an end.
bool segment_meets(double tangent, const Segment& s) {
  const Eigen::Vector3d along = s[1] - s[0];
  const double rise = tangent * along.z();
  const double across2 = along.head<2>().squaredNorm();
  double t = rise > 0 ? 1 : 0;
  if (rise * rise < across2) {
    const double nearest = -s[0].head<2>().dot(along.head<2>()) / across2;
    const double miss =
        std::abs(cross(s[0], along));  // the line's distance from the axis, times sqrt(across2)
    t = std::clamp(nearest + rise * miss / (across2 * std::sqrt(across2 - rise * rise)), 0.0, 1.0);
  }
  const Eigen::Vector3d deepest = s[0] + t * along;
  return tangent * deepest.z() >= deepest.head<2>().norm();
}

Eigen::Vector3d at_depth(const Segment& s, double z) {
  return s[0] + (z - s[0].z()) / (s[1].z() - s[0].z()) * (s[1] - s[0]);
}

bool axis_pierces(const std::array<Eigen::Vector3d, 3>& p, double far_mm) {
  const Eigen::Vector3d weights(cross(p[1], p[2]), cross(p[2], p[0]), cross(p[0], p[1]));
  const double sum = weights.sum();
  if (sum == 0 || weights.minCoeff() * sum < 0 || weights.maxCoeff() * sum < 0) return false;
  const double z = weights.dot(Eigen::Vector3d(p[0].z(), p[1].z(), p[2].z())) / sum;
  return z >= 0 && z <= far_mm;
}

}  // namespace

ViewingCone viewing_cone(const Pose<M, C>& X_MC, const ConeShape& shape) noexcept {
  ViewingCone cone;
  cone.aim(X_MC);
  cone.tangent = static_cast<float>(std::tan(shape.half_angle_rad));
  cone.sine = static_cast<float>(std::sin(shape.half_angle_rad));
  cone.cosine = static_cast<float>(std::cos(shape.half_angle_rad));
  cone.far_mm = static_cast<float>(shape.far_mm);
  return cone;
}

bool meets_cone(const ViewingCone& cone, const std::array<Eigen::Vector3f, 3>& corners_C_mm) noexcept {
  const std::array<Eigen::Vector3d, 3> p{corners_C_mm[0].cast<double>(), corners_C_mm[1].cast<double>(),
                                         corners_C_mm[2].cast<double>()};
  const double tangent = cone.tangent, far_mm = cone.far_mm;
  Segment cut;
  int cuts = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    Segment edge{p[i], p[(i + 1) % 3]};
    const bool first_far = edge[0].z() > far_mm, second_far = edge[1].z() > far_mm;
    if (first_far && second_far) continue;
    if (first_far != second_far) {
      const Eigen::Vector3d crossing = at_depth(edge, far_mm);
      edge[first_far ? 0 : 1] = crossing;
      cut[static_cast<std::size_t>(cuts++)] = crossing;  // a plane crosses at most two edges
    }
    if (segment_meets(tangent, edge)) return true;
  }
  return (cuts == 2 && segment_meets(tangent, cut)) || axis_pierces(p, far_mm);
}

}  // namespace orcart
