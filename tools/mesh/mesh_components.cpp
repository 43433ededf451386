// Union-find over vertices (Tarjan 1975).
#include "tools/mesh/mesh_components.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace orcart {

namespace {

class Forest {
 public:
  explicit Forest(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

MeshComponents components_of(const TriangleMesh& mesh) {
  Forest forest(mesh.vertices_mm.size());
  for (const auto& t : mesh.triangles) {
    forest.join(t[0], t[1]);
    forest.join(t[0], t[2]);
  }
  std::vector<std::size_t> count_at(mesh.vertices_mm.size(), 0);
  for (const auto& t : mesh.triangles) ++count_at[forest.root(t[0])];
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < count_at.size(); ++i)
    if (count_at[i] > 0) roots.push_back(i);
  std::stable_sort(roots.begin(), roots.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return count_at[a] > count_at[b]; });
  MeshComponents pieces;
  std::vector<std::uint32_t> number_of(mesh.vertices_mm.size(), 0);
  for (const std::uint32_t root : roots) {
    number_of[root] = static_cast<std::uint32_t>(pieces.triangles.size());
    pieces.triangles.push_back(count_at[root]);
  }
  pieces.component_of.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) pieces.component_of.push_back(number_of[forest.root(t[0])]);
  return pieces;
}

TriangleMesh component(const TriangleMesh& mesh, const MeshComponents& pieces, std::size_t wanted) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  TriangleMesh part;
  std::vector<std::uint32_t> index_of(mesh.vertices_mm.size(), kUnused);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (pieces.component_of[t] != wanted) continue;
    auto& corners = part.triangles.emplace_back(mesh.triangles[t]);
    for (std::uint32_t& corner : corners) {
      std::uint32_t& index = index_of[corner];
      if (index == kUnused) {
        index = static_cast<std::uint32_t>(part.vertices_mm.size());
        part.vertices_mm.push_back(mesh.vertices_mm[corner]);
      }
      corner = index;
    }
  }
  return part;
}

}  // namespace orcart
