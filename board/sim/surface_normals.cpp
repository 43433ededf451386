// Vertex normals by summing cross products: their length is twice the triangle's area, which is the weight.
#include "board/sim/surface_normals.hpp"

#include <Eigen/Geometry>

namespace orcart {

std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices_mm.size(), Eigen::Vector3f::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices_mm[t[0]];
    const Eigen::Vector3f cross = (mesh.vertices_mm[t[1]] - a).cross(mesh.vertices_mm[t[2]] - a);
    for (const std::uint32_t vertex : t) normals[vertex] += cross;
  }
  for (Eigen::Vector3f& normal : normals) normal.normalize();
  return normals;
}

}  // namespace orcart
