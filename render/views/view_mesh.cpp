// Splitting at charts, and merging within cubes.
#include "render/views/view_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include <Eigen/Geometry>

namespace orcart {
namespace {

using Key = std::uint64_t;

/// Area-weighted normals of the vertices.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices_mm.size(), Eigen::Vector3f::Zero());
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices_mm[t[0]], &b = mesh.vertices_mm[t[1]], &c = mesh.vertices_mm[t[2]];
    const Eigen::Vector3f doubled_area = (b - a).cross(c - a);
    for (const std::uint32_t corner : t) normals[corner] += doubled_area;
  }
  for (auto& n : normals) n.normalize();
  return normals;
}

Eigen::Map<const Eigen::Vector3f> position_of(const ViewVertex& vertex) {
  return Eigen::Map<const Eigen::Vector3f>(vertex.position.data());
}

/// Which cube each vertex lies in, numbered from 0 in the order of the vertices.
std::vector<std::uint32_t> cubes_of(const ViewMesh& mesh, const Eigen::Vector3f& corner_mm, float cube_mm) {
  std::unordered_map<Key, std::uint32_t> numbers;
  std::vector<std::uint32_t> cubes;
  cubes.reserve(mesh.vertices.size());
  for (const ViewVertex& vertex : mesh.vertices) {
    const Eigen::Vector3f at = (position_of(vertex) - corner_mm) / cube_mm;
    const Key key =
        static_cast<Key>(at.x()) << 42 | static_cast<Key>(at.y()) << 21 | static_cast<Key>(at.z());
    cubes.push_back(numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  return cubes;
}

std::size_t triangles_left(const ViewMesh& mesh, const std::vector<std::uint32_t>& cubes) {
  std::size_t left = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = cubes[mesh.indices[i]], b = cubes[mesh.indices[i + 1]],
                        c = cubes[mesh.indices[i + 2]];
    left += a != b && b != c && c != a ? 1 : 0;
  }
  return left;
}

/// Sums that become means.
struct Heap {
  Eigen::Vector3f position = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
  float count = 0;
  void add(const ViewVertex& vertex) {
    position += position_of(vertex);
    normal += Eigen::Map<const Eigen::Vector3f>(vertex.normal.data());
    ++count;
  }
};

struct Place {
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  float count = 0;
};

ViewMesh merged(const ViewMesh& fine, const std::vector<std::uint32_t>& cubes) {
  std::vector<Heap> heaps(1 + *std::max_element(cubes.begin(), cubes.end()));
  std::unordered_map<Key, std::uint32_t> numbers;  // (cube, chart)
  std::vector<std::uint32_t> merged_into(fine.vertices.size());
  std::vector<Place> places;
  ViewMesh out;
  std::vector<std::uint32_t> cube_of_vertex;
  for (std::size_t i = 0; i < fine.vertices.size(); ++i) {
    heaps[cubes[i]].add(fine.vertices[i]);
    const Key key = static_cast<Key>(cubes[i]) << 32 | fine.charts[i];
    const auto [at, is_new] = numbers.try_emplace(key, static_cast<std::uint32_t>(places.size()));
    if (is_new) {
      places.emplace_back();
      cube_of_vertex.push_back(cubes[i]);
      out.charts.push_back(fine.charts[i]);
    }
    places[at->second].sum += Eigen::Map<const Eigen::Vector2f>(fine.vertices[i].texel.data());
    ++places[at->second].count;
    merged_into[i] = at->second;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Heap& heap = heaps[cube_of_vertex[i]];
    const Eigen::Vector3f p = heap.position / heap.count, n = heap.normal.normalized();
    const Eigen::Vector2f uv = places[i].sum / places[i].count;
    out.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {uv.x(), uv.y()}});
  }
  for (std::size_t i = 0; i + 2 < fine.indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{fine.indices[i], fine.indices[i + 1], fine.indices[i + 2]};
    const std::uint32_t a = cubes[t[0]], b = cubes[t[1]], c = cubes[t[2]];
    if (a == b || b == c || c == a) continue;
    for (const std::uint32_t corner : t) out.indices.push_back(merged_into[corner]);
  }
  return out;
}

}  // namespace

ViewMesh view_mesh(const TriangleMesh& mesh, const AtlasLayout& layout) {
  const auto normals = vertex_normals(mesh);
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return layout.chart_of_triangle[a] < layout.chart_of_triangle[b];
  });
  ViewMesh out;
  out.indices.reserve(mesh.triangles.size() * 3);
  std::unordered_map<Key, std::uint32_t> numbers;  // (chart, vertex)
  for (const std::uint32_t t : order) {
    const std::uint32_t chart = layout.chart_of_triangle[t];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangles[t][c];
      const auto [at, is_new] = numbers.try_emplace(static_cast<Key>(chart) << 32 | v,
                                                    static_cast<std::uint32_t>(out.vertices.size()));
      if (is_new) {
        const auto &p = mesh.vertices_mm[v], &n = normals[v];
        const auto& uv = layout.corners_texels[t][c];
        out.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {uv.x(), uv.y()}});
        out.charts.push_back(chart);
      }
      out.indices.push_back(at->second);
    }
  }
  return out;
}

ViewMesh coarser(const ViewMesh& fine, std::size_t most_triangles) {
  if (fine.indices.size() / 3 <= most_triangles) return fine;
  Eigen::AlignedBox3f box;
  double area_mm2 = 0;
  for (const ViewVertex& vertex : fine.vertices) box.extend(position_of(vertex));
  for (std::size_t i = 0; i + 2 < fine.indices.size(); i += 3) {
    const Eigen::Vector3f a = position_of(fine.vertices[fine.indices[i]]);
    area_mm2 += (position_of(fine.vertices[fine.indices[i + 1]]) - a)
                    .cross(position_of(fine.vertices[fine.indices[i + 2]]) - a)
                    .norm() /
                2;
  }
  // A cube's cut through a surface bears about two triangles.
  float cube_mm = static_cast<float>(std::sqrt(2 * area_mm2 / static_cast<double>(most_triangles))) * 0.7F;
  for (int attempt = 0; attempt < 60; ++attempt, cube_mm *= 1.05F) {
    const std::vector<std::uint32_t> cubes = cubes_of(fine, box.min(), cube_mm);
    if (triangles_left(fine, cubes) <= most_triangles) return merged(fine, cubes);
  }
  return fine;
}

}  // namespace orcart
