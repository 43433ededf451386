// A surface as indexed triangles in mesh space, with where it came from. Plain data; checks are beside it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace orcart {

/// Millimetres, LPS. Triangles are counter-clockwise seen from the side the normal points to (outward when
/// closed).
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The side of the surface a scope looks at: a ventricle is seen from inside, a cortex from outside.
enum class SeenFrom { outside, inside };

/// What a surface file carries besides its triangles.
struct SurfaceIdentity {
  std::string hash;                ///< hex of a 128-bit hash over vertices and triangles, in order
  std::string series;              ///< DICOM series or source file; empty where the file says nothing
  std::string frame_of_reference;  ///< DICOM frame of reference UID; empty where the file says nothing
};

/// A triangle mesh that passed its checks, ready for the cart.
struct Surface {
  TriangleMesh mesh;
  SurfaceIdentity identity;
  bool closed = false;  ///< every edge has exactly two triangles
};

}  // namespace orcart
