// Sums over the triangles of a vertex.
#include "firmware-host/files/vertex_normals.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace orcart {
namespace {

Eigen::Vector3f cross_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3f& a = mesh.vertices_mm[t[0]];
  return (mesh.vertices_mm[t[1]] - a).cross(mesh.vertices_mm[t[2]] - a);
}

}  // namespace

std::vector<Eigen::Vector3f> angle_weighted_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices_mm.size(), Eigen::Vector3f::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f cross = cross_of(mesh, t);
    const float area2 = cross.norm();
    if (!(area2 > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3f& here = mesh.vertices_mm[t[c]];
      const float along =
          (mesh.vertices_mm[t[(c + 1) % 3]] - here).dot(mesh.vertices_mm[t[(c + 2) % 3]] - here);
      normals[t[c]] += std::atan2(area2, along) / area2 * cross;
    }
  }
  for (Eigen::Vector3f& normal : normals)
    normal = normal.norm() > 0 ? Eigen::Vector3f(normal.normalized()) : Eigen::Vector3f::UnitZ();
  return normals;
}

NormalVotes vote_on_winding(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& normals) {
  NormalVotes votes;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f cross = cross_of(mesh, t);
    for (const std::uint32_t vertex : t) {
      const float side = cross.dot(normals[vertex]);
      votes.along += side > 0 ? 1 : 0;
      votes.against += side < 0 ? 1 : 0;
    }
  }
  return votes;
}

}  // namespace orcart
