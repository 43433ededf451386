// The figures a person judges a surface by.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

struct MeshFigures {
  std::size_t vertices = 0, triangles = 0, edges = 0;
  std::size_t components = 0;
  double area_mm2 = 0;
  double volume_ml = 0;        ///< enclosed; of an open surface only what the divergence theorem makes of it
  long euler_number = 0;       ///< vertices - edges + triangles; 2 for a ball, 2 less for each handle
  std::size_t open_edges = 0;  ///< with one triangle
  std::size_t crowded_edges = 0;    ///< with more than two triangles
  std::size_t misturned_edges = 0;  ///< whose two triangles run along it in the same direction
  std::size_t piercing_edges = 0;   ///< that go through a triangle which shares no vertex with them
  Eigen::Vector3f pierced_at_mm = Eigen::Vector3f::Zero();  ///< one place where that happens
  std::size_t inverted_components = 0;  ///< closed, inside out, and no hollow of another; 0 where not certain
  Eigen::Vector3f inverted_at_mm = Eigen::Vector3f::Zero();  ///< a vertex of one
  Eigen::Vector3f lowest_mm = Eigen::Vector3f::Zero(), highest_mm = Eigen::Vector3f::Zero();
};

/// Vertices that no triangle uses count too. Casts a ray along each edge (Embree) to find where the surface
/// goes through itself.
Result<MeshFigures> measure_mesh(const TriangleMesh& mesh);

/// One sentence where the surface is no good skin of a solid: open, branching, turned over, in part inside
/// out or through itself.
std::optional<std::string> trouble_of(const MeshFigures& figures);

}  // namespace orcart
