// Thins a closed surface out without ever opening it.
#pragma once

#include <cstddef>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// Edge collapses in the order of their quadric error (Garland and Heckbert 1997) until `triangles` are left
/// or none can go. A collapse must meet the link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999), so a
/// closed manifold stays one of the same genus, and must turn no triangle over. Deterministic.
TriangleMesh decimate(const TriangleMesh& mesh, std::size_t triangles);

}  // namespace orcart
