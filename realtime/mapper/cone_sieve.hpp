// Which triangles of one cluster meet the viewing cone: scratch and answer of the vector code that tells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "realtime/geometry/cone_walk.hpp"

namespace orcart {

/// A cluster's vertices in C and where each lies about the cone. Lives with its owner, one cluster after
/// another.
struct SieveScratch {
  static constexpr std::size_t kRoom = ClusterTree::kMaxVertices + 16;  ///< whole vectors are written
  /// Bit 0: inside the cone. Other bits: beyond one of the planes that bound the cone; three corners beyond
  /// one plane, and the triangle is out.
  alignas(64) std::array<std::uint32_t, kRoom> notes{};
  alignas(64) std::array<float, kRoom> x{}, y{}, z{};  ///< in C, mm
};
constexpr std::uint32_t kNoteInside = 1;

/// A bit a triangle of the cluster.
struct SieveAnswer {
  std::uint64_t meets = 0;        ///< shares a point with the cone
  std::uint64_t with_corner = 0;  ///< has a corner in the cone
  std::uint64_t whole = 0;        ///< has all three in it
};

/// Whether a point lies in the cone, in double precision, from the cone's numbers as they are.
bool point_in_cone(const ConeNumbers& cone, float x_mm, float y_mm, float z_mm) noexcept;

/// The exact test (meets_cone) of the triangles that the notes leave open; returns those that meet.
std::uint64_t meeting_of(const SieveScratch& scratch, const std::uint8_t* corners, const ConeNumbers& cone,
                         std::uint64_t open) noexcept;

}  // namespace orcart
