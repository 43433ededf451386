// What can be asked of a cluster tree once it is built.
#include "realtime/geometry/cluster_tree.hpp"

#include <algorithm>

namespace orcart {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

ClusterTree::Cluster ClusterTree::cluster(std::uint32_t index) const noexcept {
  const std::size_t first_vertex = first_vertex_[index];
  const std::size_t vertices = first_vertex_[index + 1] - first_vertex;
  const std::size_t first = index * kMaxTriangles;
  const std::size_t triangles = std::min(kMaxTriangles, triangle_count_ - first);
  return {.x = {x_.data() + first_vertex, vertices},
          .y = {y_.data() + first_vertex, vertices},
          .z = {z_.data() + first_vertex, vertices},
          .vertex_ids = {vertex_ids_.data() + first_vertex, vertices},
          .corners = {corners_.data() + first, triangles},
          .triangle_ids = {triangle_ids_.data() + first, triangles}};
}

std::size_t ClusterTree::bytes() const noexcept {
  return bytes_of(x_) + bytes_of(y_) + bytes_of(z_) + bytes_of(vertex_ids_) + bytes_of(triangle_ids_) +
         bytes_of(corners_) + bytes_of(first_vertex_) + bytes_of(nodes_);
}

}  // namespace orcart
