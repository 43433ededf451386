// Small surfaces whose every point is known, and a reader for the surfaces used in benches.
#pragma once

#include <string>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart::testing {

/// A square of side size_mm in the plane z = z_mm about (0, 0), cells x cells squares of two triangles,
/// normals along -z (towards a scope at the origin that looks along +z).
Surface plane_facing_origin(double size_mm, double z_mm, int cells);
/// A closed sphere about the origin, normals outward, of 2 * rings * segments - 2 * segments triangles.
Surface sphere(double radius_mm, int rings, int segments);
/// The second surface beside the first.
Surface joined(const Surface& a, const Surface& b);
/// Binary little-endian PLY of float x y z and triangles, as in the benches; empty where the file cannot be
/// read.
Surface bench_surface(const std::string& path);

}  // namespace orcart::testing
