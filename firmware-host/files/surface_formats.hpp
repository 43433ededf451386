// The four surface formats, parsed from memory: each gives triangles and what the file says of itself,
// unchecked beyond that.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/vertex_normals.hpp"
#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

constexpr std::size_t kLargestTriangleCount = 4'000'000;
constexpr std::size_t kLargestVertexCount = 3 * kLargestTriangleCount;

/// A surface as its file has it: coordinates not yet converted, indices within range, numbers perhaps not
/// finite.
struct ParsedSurface {
  TriangleMesh mesh;
  SurfaceIdentity stated;            ///< hash, series and frame of reference where the file has them
  NormalVotes normals;               ///< none where the file states no normals
  std::optional<std::string> space;  ///< the word after SPACE= (3D Slicer's convention), e.g. LPS
};

/// What every reader does once it has the triangles: obeys the stated space (or `where_unstated`), checks,
/// and gives the surface its identity; as read_surface says. `name` is the file's, for messages.
Result<Surface> finish_surface(ParsedSurface parsed, const std::string& name, SurfaceNotes* notes,
                               std::optional<Space> where_unstated);

/// `name` is the file's, for messages. The whole file must be in `bytes`; hostile bytes give an error, never
/// more memory than a small multiple of their count.
Result<ParsedSurface> parse_ply(std::span<const std::byte> bytes, const std::string& name);
Result<ParsedSurface> parse_stl(std::span<const std::byte> bytes, const std::string& name);
Result<ParsedSurface> parse_obj(std::span<const std::byte> bytes, const std::string& name);
/// Surf Ice's mz3, gzipped or not: 0x5A4D, what it holds, counts, triangles and single-precision vertices.
Result<ParsedSurface> parse_mz3(std::span<const std::byte> bytes, const std::string& name);

/// Takes what one comment line says: SPACE=..., and orcart's own `orcart hash|series|frame_of_reference ...`.
void take_comment(std::string_view comment, ParsedSurface& surface);

/// Cuts a polygon into triangles whose corners run as its own do: a fan from its first corner where all turns
/// agree, and else ears clipped in its mean plane (Meisters 1975) until they do. What crosses itself, or has
/// over 1000 corners, is fanned. False where an index is beyond `vertex_count`.
bool append_polygon(std::span<const std::uint32_t> corners, std::size_t vertex_count, TriangleMesh& mesh);

}  // namespace orcart
