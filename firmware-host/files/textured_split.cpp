// Few vertices have a second place: those are looked up, the rest are where they were.
#include "firmware-host/files/textured_split.hpp"

#include <map>
#include <tuple>

namespace orcart {

SplitSurface split_along_seams(const TexturedSurface& textured) {
  const TriangleMesh& mesh = textured.surface.mesh;
  SplitSurface out;
  out.places.assign(mesh.vertices_mm.size(), Eigen::Vector2f::Zero());
  for (std::uint32_t v = 0; v < out.places.size(); ++v) out.vertex_of.push_back(v);
  out.indices.reserve(3 * mesh.triangles.size());
  std::vector<bool> has_place(out.places.size(), false);
  std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> further;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[t][c];
      const Eigen::Vector2f& place = textured.corners_uv[t][c];
      if (!has_place[vertex]) {
        has_place[vertex] = true;
        out.places[vertex] = place;
      }
      if (out.places[vertex] == place) {
        out.indices.push_back(vertex);
        continue;
      }
      const auto [at, is_new] =
          further.try_emplace({vertex, place.x(), place.y()}, static_cast<std::uint32_t>(out.places.size()));
      if (is_new) {
        out.vertex_of.push_back(vertex);
        out.places.push_back(place);
      }
      out.indices.push_back(at->second);
    }
  }
  return out;
}

}  // namespace orcart
