// The walk of a viewing cone through the cluster tree.
#include "realtime/geometry/cluster_tree.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {
namespace {

constexpr std::uint32_t kInside = 1U << 30;  // beside kLeaf: the sphere lies wholly inside the cone

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

ClusterTree::Cluster ClusterTree::cluster(std::uint32_t index) const noexcept {
  const Part& part = parts_[index];
  const Part& end = parts_[index + 1];
  const std::size_t vertices = end.first_vertex - part.first_vertex;
  const std::size_t triangles = end.first_triangle - part.first_triangle;
  return {.x = {x_.data() + part.first_vertex, vertices},
          .y = {y_.data() + part.first_vertex, vertices},
          .z = {z_.data() + part.first_vertex, vertices},
          .vertex_ids = {vertex_ids_.data() + part.first_vertex, vertices},
          .corners = {corners_.data() + part.first_triangle, triangles},
          .triangle_ids = {triangle_ids_.data() + part.first_triangle, triangles}};
}

std::size_t ClusterTree::bytes() const noexcept {
  return bytes_of(x_) + bytes_of(y_) + bytes_of(z_) + bytes_of(vertex_ids_) + bytes_of(triangle_ids_) +
         bytes_of(corners_) + bytes_of(parts_) + bytes_of(nodes_);
}

void ConeWalk::begin(const ClusterTree& tree) noexcept {
  size_ = 0;
  if (!tree.nodes().empty()) stack_[size_++] = {};
}

void ConeWalk::push_children(const ClusterTree::Node& node, const ViewingCone& cone, bool inside) noexcept {
  const Eigen::Vector3f axis = cone.R_CM.row(2);
  std::array<float, ClusterTree::kWidth> side{},
      along{};  // distance from the cone's flank (inside: < 0), and depth
  for (std::size_t i = 0; i < ClusterTree::kWidth; ++i) {
    const float dx = node.x[i] - cone.apex_mm.x(), dy = node.y[i] - cone.apex_mm.y(),
                dz = node.z[i] - cone.apex_mm.z();
    const float z = dx * axis.x() + dy * axis.y() + dz * axis.z();
    const float rho2 = dx * dx + dy * dy + dz * dz - z * z;
    along[i] = z;
    side[i] = std::sqrt(rho2 > 0 ? rho2 : 0.F) * cone.cosine - z * cone.sine;
  }
  const std::size_t first = size_;
  for (std::size_t i = 0; i < ClusterTree::kWidth; ++i) {
    const float r = node.radius[i];
    if (!(side[i] <= r && along[i] - r <= cone.far_mm && along[i] + r >= 0)) continue;
    const bool child_inside = inside || (side[i] < -r && along[i] + r < cone.far_mm);
    const Entry entry{.depth_mm = along[i], .child = node.child[i] | (child_inside ? kInside : 0)};
    std::size_t at = size_++;
    for (; at > first && stack_[at - 1].depth_mm < entry.depth_mm; --at) stack_[at] = stack_[at - 1];
    stack_[at] = entry;
  }
}

bool ConeWalk::next(const ClusterTree& tree, const ViewingCone& cone, ClusterVisit& visit) noexcept {
  while (size_ > 0) {
    const std::uint32_t entry = stack_[--size_].child;
    const std::uint32_t index = entry & ~(ClusterTree::kLeaf | kInside);
    const bool inside = (entry & kInside) != 0;
    if ((entry & ClusterTree::kLeaf) != 0) {
      visit = {.cluster = index, .inside = inside};
      return true;
    }
    push_children(tree.nodes()[index], cone, inside);
  }
  return false;
}

}  // namespace orcart
