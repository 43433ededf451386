// Counts edges by sorting them, and sends a ray along each.
#include "tools/mesh/mesh_figures.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "realtime/geometry/ray_scene.hpp"
#include "tools/mesh/mesh_components.hpp"

namespace orcart {

namespace {

struct Edge {
  std::uint32_t low = 0, high = 0;
  bool forward = false;
  bool operator<(const Edge& other) const {
    return std::tie(low, high, forward) < std::tie(other.low, other.high, other.forward);
  }
  bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
};

std::vector<Edge> edges_of(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

bool shares_vertex(const std::array<std::uint32_t, 3>& triangle, const Edge& edge) {
  return std::any_of(triangle.begin(), triangle.end(),
                     [&](std::uint32_t v) { return v == edge.low || v == edge.high; });
}

/// Where an edge goes through a triangle that it does not belong to.
std::optional<Eigen::Vector3f> pierced(const TriangleMesh& mesh, const RayScene& rays, const Edge& edge) {
  const Eigen::Vector3f a = mesh.vertices_mm[edge.low], along = mesh.vertices_mm[edge.high] - a;
  const float length = along.norm();
  if (length < 1e-6F) return std::nullopt;
  const Eigen::Vector3f direction = along / length;
  const float end = length * (1 - 1e-4F);
  float from = length * 1e-4F;
  constexpr int kMostNeighbours = 8;
  for (int i = 0; i < kMostNeighbours && from < end; ++i) {
    const auto hit = rays.nearest(a, direction, end, from);
    if (!hit) return std::nullopt;
    if (!shares_vertex(mesh.triangles[hit->triangle], edge)) return a + hit->distance_mm * direction;
    from = hit->distance_mm + length * 1e-3F;
  }
  return std::nullopt;
}

void count_edges(const TriangleMesh& mesh, const RayScene& rays, MeshFigures& figures) {
  const std::vector<Edge> edges = edges_of(mesh);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].same_ends(edges[i])) ++end;
    ++figures.edges;
    if (end - i == 1) ++figures.open_edges;
    if (end - i > 2) ++figures.crowded_edges;
    if (end - i == 2 && edges[i].forward == edges[i + 1].forward) ++figures.misturned_edges;
    if (const auto place = pierced(mesh, rays, edges[i])) {
      ++figures.piercing_edges;
      figures.pierced_at_mm = *place;
    }
    i = end;
  }
}

/// How often the other pieces enclose a place, by where a ray from it leaves and enters them: 1 within one
/// piece, 0 outside all and within a hollow.
int enclosed(const TriangleMesh& mesh, const RayScene& rays, const MeshComponents& pieces, std::size_t own,
             const Eigen::Vector3f& place, const Eigen::Vector3f& direction) {
  constexpr int kMostHits = 10'000;
  constexpr float kFar_mm = 100'000;
  int count = 0;
  float from = 0;
  for (int i = 0; i < kMostHits; ++i) {
    const auto hit = rays.nearest(place, direction, kFar_mm, from);
    if (!hit) break;
    from = std::max(hit->distance_mm * (1 + 1e-6F), hit->distance_mm + 1e-5F);
    if (pieces.component_of[hit->triangle] == own) continue;
    const auto& t = mesh.triangles[hit->triangle];
    const Eigen::Vector3f normal = (mesh.vertices_mm[t[1]] - mesh.vertices_mm[t[0]])
                                       .cross(mesh.vertices_mm[t[2]] - mesh.vertices_mm[t[0]]);
    count += normal.dot(direction) > 0 ? 1 : -1;
  }
  return count;
}

/// Closed pieces of negative volume that lie in no other: what is inside one counts as outside.
void count_inverted(const TriangleMesh& mesh, const RayScene& rays, const MeshComponents& pieces,
                    MeshFigures& figures) {
  std::vector<double> six_volumes(pieces.triangles.size(), 0);
  std::vector<std::uint32_t> first(pieces.triangles.size(), 0);
  for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
    const auto& corners = mesh.triangles[t];
    const Eigen::Vector3d a = mesh.vertices_mm[corners[0]].cast<double>(),
                          b = mesh.vertices_mm[corners[1]].cast<double>(),
                          c = mesh.vertices_mm[corners[2]].cast<double>();
    six_volumes[pieces.component_of[t]] += a.dot(b.cross(c));
    first[pieces.component_of[t]] = corners[0];
  }
  const std::array directions = {Eigen::Vector3f(0.267F, 0.534F, 0.802F).normalized(),
                                 Eigen::Vector3f(-0.731F, 0.211F, -0.649F).normalized(),
                                 Eigen::Vector3f(0.413F, -0.877F, 0.245F).normalized()};
  for (std::size_t piece = 0; piece < six_volumes.size(); ++piece) {
    if (six_volumes[piece] >= 0) continue;
    const Eigen::Vector3f place = mesh.vertices_mm[first[piece]];
    int outside = 0;  // a ray may graze an edge: two of three decide
    for (const Eigen::Vector3f& direction : directions)
      outside += enclosed(mesh, rays, pieces, piece, place, direction) <= 0 ? 1 : 0;
    if (outside < 2) continue;
    ++figures.inverted_components;
    figures.inverted_at_mm = place;
  }
}

}  // namespace

Result<MeshFigures> measure_mesh(const TriangleMesh& mesh) {
  const auto rays = RayScene::create(mesh);
  if (!rays) return tl::unexpected(rays.error());
  MeshFigures figures{.vertices = mesh.vertices_mm.size(), .triangles = mesh.triangles.size()};
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>(),
                          b = mesh.vertices_mm[t[1]].cast<double>(),
                          c = mesh.vertices_mm[t[2]].cast<double>();
    figures.area_mm2 += (b - a).cross(c - a).norm() / 2;
    six_volumes += a.dot(b.cross(c));
  }
  figures.volume_ml = six_volumes / 6000;
  const MeshComponents pieces = components_of(mesh);
  figures.components = pieces.triangles.size();
  figures.lowest_mm = figures.highest_mm = mesh.vertices_mm.front();
  for (const auto& vertex : mesh.vertices_mm) {
    figures.lowest_mm = figures.lowest_mm.cwiseMin(vertex);
    figures.highest_mm = figures.highest_mm.cwiseMax(vertex);
  }
  count_edges(mesh, *rays, figures);
  if (figures.open_edges + figures.crowded_edges + figures.misturned_edges == 0)
    count_inverted(mesh, *rays, pieces, figures);
  figures.euler_number = static_cast<long>(figures.vertices) - static_cast<long>(figures.edges) +
                         static_cast<long>(figures.triangles);
  return figures;
}

std::optional<std::string> trouble_of(const MeshFigures& figures) {
  char text[320];
  if (figures.crowded_edges + figures.misturned_edges > 0) {
    std::snprintf(text, sizeof text,
                  "%zu edges have more than two triangles and at %zu the triangles face opposite ways; which "
                  "side is outside is not certain there, so repair the surface where it was made",
                  figures.crowded_edges, figures.misturned_edges);
    return text;
  }
  if (figures.open_edges > 0) {
    std::snprintf(
        text, sizeof text,
        "it is open along %zu edges; paint works, but what is inside cannot be told near the holes, "
        "so close it where it was made if the scope looks there",
        figures.open_edges);
    return text;
  }
  if (figures.inverted_components > 0) {
    std::snprintf(
        text, sizeof text,
        "%zu of its pieces are inside out, e.g. the one at (%.1f, %.1f, %.1f) mm LPS; what is inside "
        "them counts as outside, so turn their faces where they were made",
        figures.inverted_components, static_cast<double>(figures.inverted_at_mm.x()),
        static_cast<double>(figures.inverted_at_mm.y()), static_cast<double>(figures.inverted_at_mm.z()));
    return text;
  }
  if (figures.piercing_edges > 0) {
    std::snprintf(
        text, sizeof text,
        "it goes through itself at %zu edges, e.g. at (%.1f, %.1f, %.1f) mm LPS; paint lands on the "
        "outer sheet there, so smooth less or repair it where it was made",
        figures.piercing_edges, static_cast<double>(figures.pierced_at_mm.x()),
        static_cast<double>(figures.pierced_at_mm.y()), static_cast<double>(figures.pierced_at_mm.z()));
    return text;
  }
  return std::nullopt;
}

}  // namespace orcart
