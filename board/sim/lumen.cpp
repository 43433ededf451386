// Inside, clearance and free ways by rays.
#include "board/sim/lumen.hpp"

#include <algorithm>
#include <array>

#include "board/sim/directions.hpp"

namespace orcart {
namespace {

const std::vector<Eigen::Vector3f>& all_around(int count) {
  static const auto few = spiral_directions(Eigen::Vector3f::UnitZ(), std::numbers::pi, 14);
  static const auto many = spiral_directions(Eigen::Vector3f::UnitZ(), std::numbers::pi, 162);
  return count <= 14 ? few : many;
}

}  // namespace

bool inside(const TriangleMesh& mesh, const RayScene& rays, const Eigen::Vector3f& point_mm) {
  int leaving = 0;
  for (const Eigen::Vector3f& direction : all_around(14)) {
    const auto hit = rays.nearest(point_mm, direction, 1e4F);
    if (!hit) continue;
    const auto& t = mesh.triangles[hit->triangle];
    const Eigen::Vector3f a = mesh.vertices_mm[t[0]];
    leaving += (mesh.vertices_mm[t[1]] - a).cross(mesh.vertices_mm[t[2]] - a).dot(direction) > 0;
  }
  return leaving > 7;
}

float clearance_mm(const RayScene& rays, const Eigen::Vector3f& point_mm, float reach_mm) {
  std::array<RayHit, 162> hits;
  rays.nearest_many(point_mm, all_around(162), reach_mm, hits);
  float least = reach_mm;
  for (const RayHit& hit : hits)
    if (hit.distance_mm >= 0) least = std::min(least, hit.distance_mm);
  return least;
}

bool free_way(const RayScene& rays, const Eigen::Vector3f& from_mm, const Eigen::Vector3f& to_mm,
              float room_mm) {
  const int steps = 1 + static_cast<int>((to_mm - from_mm).norm() / 0.7F);
  for (int i = 0; i <= steps; ++i) {
    const float part = static_cast<float>(i) / static_cast<float>(steps);
    if (clearance_mm(rays, from_mm + part * (to_mm - from_mm), room_mm + 1) < room_mm) return false;
  }
  return true;
}

}  // namespace orcart
