// Surfaces in and out: PLY, STL and OBJ are read and checked, PLY is written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/files/space.hpp"
#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// What was mended or noticed while reading; each is one sentence for the person.
struct SurfaceNotes {
  std::vector<std::string> sentences;
};

/// Reads and validates. Degenerate triangles are dropped and told; NaN, an empty file, indices out of range
/// and more than 4 million triangles are refused with file, value and what would be accepted. An open surface
/// is accepted and told; a closed one that is inside out is turned. Coordinates become LPS mm: a file that
/// states its space
/// (`SPACE=LPS` or `SPACE=RAS` in a comment, as 3D Slicer writes) is obeyed; one that states none is taken to
/// be `where_unstated`, and refused where that is not told. A file that states a hash of its own must match
/// it. A PLY's normals are not kept, since they follow from the triangles; where most of an open surface's
/// point against its winding, it is told.
Result<Surface> read_surface(const std::filesystem::path& file, SurfaceNotes* notes = nullptr,
                             std::optional<Space> where_unstated = std::nullopt);

/// Binary little-endian PLY with the identity in comments and angle_weighted_normals(). Written beside and
/// renamed: never half a file.
Result<void> write_ply(const std::filesystem::path& file, const Surface& surface);

/// Checks a mesh made in memory (LPS mm) the same way and gives it its hash; `name` is for messages.
Result<Surface> make_surface(TriangleMesh mesh, const std::string& name, SurfaceNotes* notes = nullptr);

}  // namespace orcart
