// One index for vertices that a file repeats: STL at every triangle, textured PLY along the seams of its
// picture.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// Gives equal vertices one index; -0 and 0 are equal.
class VertexMerger {
 public:
  explicit VertexMerger(TriangleMesh& mesh) : mesh_(mesh) {}

  std::uint32_t index_of(Eigen::Vector3f vertex) {
    vertex.array() += 0.0F;  // -0 becomes 0
    const Bits bits{std::bit_cast<std::uint32_t>(vertex.x()), std::bit_cast<std::uint32_t>(vertex.y()),
                    std::bit_cast<std::uint32_t>(vertex.z())};
    const auto [at, fresh] = index_.try_emplace(bits, static_cast<std::uint32_t>(mesh_.vertices_mm.size()));
    if (fresh) mesh_.vertices_mm.push_back(vertex);
    return at->second;
  }

 private:
  using Bits = std::array<std::uint32_t, 3>;
  struct Mixed {
    std::size_t operator()(const Bits& bits) const {
      std::uint64_t mixed = 0;
      for (const std::uint32_t word : bits) {
        mixed = (mixed ^ word) * 0x9E3779B97F4A7C15U;
        mixed ^= mixed >> 32U;
      }
      return mixed;
    }
  };
  TriangleMesh& mesh_;
  std::unordered_map<Bits, std::uint32_t, Mixed> index_;
};

/// Of a mesh that is whole: equal vertices become one, in the order in which they come first.
inline void merge_equal_vertices(TriangleMesh& mesh) {
  const std::vector<Eigen::Vector3f> repeated = std::exchange(mesh.vertices_mm, {});
  VertexMerger merger(mesh);
  std::vector<std::uint32_t> index;
  index.reserve(repeated.size());
  for (const Eigen::Vector3f& vertex : repeated) index.push_back(merger.index_of(vertex));
  for (auto& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = index[corner];
}

}  // namespace orcart
