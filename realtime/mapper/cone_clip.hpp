// The part of a triangle that lies in the viewing cone, as a polygon.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "realtime/mapper/cone_sieve.hpp"

namespace orcart {

/// Edges of a cluster from a corner in the cone to one outside. Lives with its owner, one cluster after
/// another.
struct ConeExits {
  static constexpr std::size_t kRoom =
      2 * ClusterTree::kMaxTriangles + 16;                   ///< whole vectors are read and written
  alignas(64) std::array<std::int32_t, kRoom> from{}, to{};  ///< vertices of the cluster
  alignas(64) std::array<float, kRoom> fraction{};  ///< of the way, at which the edge leaves the cone
  std::uint32_t count = 0;
};

/// A corner of the polygon: on the edge between two corners of the triangle, at `fraction` of the way.
struct ClipPoint {
  std::uint8_t from = 0, to = 0;  ///< the same: a corner of the triangle
  float fraction = 0;
};
struct ClipPolygon {
  std::array<ClipPoint, 6> point{};
  std::uint32_t size = 0;
};

/// A triangle in C (mm) and which of its corners count as inside.
struct ClipTriangle {
  std::array<std::array<float, 3>, 3> corner;
  std::array<bool, 3> inside;
};

/// Exact where its edges cross the cone and the far plane (the roots of a quadratic), straight between. Empty
/// where no edge meets the cone. With CutoutRule::corner edges between two outer corners are not looked at.
/// An edge gives the same points whichever of its two triangles asks.
ClipPolygon clip_to_cone(const ConeNumbers& cone, const ClipTriangle& triangle, bool outer_edges) noexcept;

}  // namespace orcart
