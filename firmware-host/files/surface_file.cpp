// Surfaces in: picks the parser, obeys the space the file states, checks, and gives the surface its identity.
#include "firmware-host/files/surface_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "firmware-host/files/surface_checks.hpp"
#include "firmware-host/files/surface_formats.hpp"
#include "firmware-host/files/vertex_merger.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {

namespace {

constexpr std::uintmax_t kLargestSurfaceBytes = std::uintmax_t{2} << 30U;
constexpr float kFarthestMm = 10'000;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

Result<ParsedSurface> parse(std::span<const std::byte> bytes, const std::filesystem::path& file) {
  const std::string name = file.string(), kind = lower(file.extension().string());
  if (bytes.empty()) return fail(name + ": is empty; a PLY, STL or OBJ surface is expected");
  if (kind == ".ply") return parse_ply(bytes, name);
  if (kind == ".stl") return parse_stl(bytes, name);
  if (kind == ".obj") return parse_obj(bytes, name);
  if (kind == ".mz3") return parse_mz3(bytes, name);
  return fail(name + ": ends in \"" + kind + "\"; .ply, .stl, .obj and .mz3 are accepted");
}

/// The space to convert from, or why it is not known.
Result<Space> space_of(const ParsedSurface& surface, std::optional<Space> where_unstated,
                       const std::string& name) {
  if (surface.space) {
    const std::string stated = lower(*surface.space);
    if (stated == "lps") return Space::lps;
    if (stated == "ras") return Space::ras;
    return fail(name + ": states SPACE=" + surface.space->substr(0, 20) + "; LPS and RAS are accepted");
  }
  if (where_unstated) return *where_unstated;
  return fail(
      name +
      ": states no coordinate system; a comment SPACE=LPS or SPACE=RAS in it is expected, or to be told "
      "which it is");
}

/// LPS and RAS differ by half a turn about the vertical: both axes of the horizontal plane change sign.
void convert_to_lps(Space space, TriangleMesh& mesh) {
  if (space == Space::lps) return;
  for (Eigen::Vector3f& vertex : mesh.vertices_mm)
    vertex.head<2>() = -vertex.head<2>().array() + 0.0F;  // 0 stays 0, and is no -0
}

std::string shown(const Eigen::Vector3f& vertex) {
  return "(" + std::to_string(vertex.x()) + ", " + std::to_string(vertex.y()) + ", " +
         std::to_string(vertex.z()) + ")";
}

Result<void> check_numbers(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.vertices_mm.empty() || mesh.triangles.empty())
    return fail(name + ": has " + std::to_string(mesh.vertices_mm.size()) + " vertices and " +
                std::to_string(mesh.triangles.size()) +
                " triangles; a surface with at least one is expected");
  if (mesh.triangles.size() > kLargestTriangleCount)
    return fail(name + ": has " + std::to_string(mesh.triangles.size()) + " triangles; up to " +
                std::to_string(kLargestTriangleCount) + " are accepted");
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    const Eigen::Vector3f& vertex = mesh.vertices_mm[i];
    if (!vertex.allFinite() || vertex.cwiseAbs().maxCoeff() > kFarthestMm)
      return fail(name + ": vertex " + std::to_string(i) + " is " + shown(vertex) +
                  "; numbers from -10000 to 10000 mm are accepted");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t index : mesh.triangles[i])
      if (index >= mesh.vertices_mm.size())
        return fail(name + ": triangle " + std::to_string(i) + " has vertex " + std::to_string(index) +
                    "; 0 to " + std::to_string(mesh.vertices_mm.size() - 1) + " are accepted");
  return {};
}

/// Some programs give each triangle, or each patch of one normal, vertices of its own. Where equal ones
/// joined leave fewer edges open, they are joined; says how many went.
std::size_t join_split_vertices(TriangleMesh& mesh) {
  TriangleMesh joined = mesh;
  merge_equal_vertices(joined);
  const std::size_t fewer = mesh.vertices_mm.size() - joined.vertices_mm.size();
  if (fewer == 0 || checks::unpaired_edges(joined) >= checks::unpaired_edges(mesh)) return 0;
  mesh = std::move(joined);
  return fewer;
}

}  // namespace

Result<Surface> make_surface(TriangleMesh mesh, const std::string& name, SurfaceNotes* notes) {
  if (auto checked = check_numbers(mesh, name); !checked) return tl::unexpected(checked.error());
  const auto note = [&](const std::string& sentence) {
    if (notes != nullptr) notes->sentences.push_back(name + ": " + sentence);
  };
  const bool was_closed = checks::is_closed(mesh);
  const std::size_t slivers = checks::flip_slivers(mesh);
  if (slivers > 0)
    note(std::to_string(slivers) + " triangles without area lay along a neighbour and were joined with it");
  const std::size_t dropped = checks::drop_degenerate_triangles(mesh);
  if (dropped > 0) note(std::to_string(dropped) + " triangles without area were dropped");
  if (mesh.triangles.empty()) return fail(name + ": has no triangle with an area; at least one is expected");
  Surface surface{.mesh = std::move(mesh), .identity = {}, .closed = false};
  surface.closed = checks::is_closed(surface.mesh);
  if (!surface.closed) note("the surface is open: some edges do not have exactly two triangles");
  if (was_closed && checks::signed_volume_mm3(surface.mesh) < 0) {
    for (auto& triangle : surface.mesh.triangles) std::swap(triangle[1], triangle[2]);
    note("the surface was inside out; its triangles were turned");
  }
  surface.identity.hash = checks::mesh_hash(surface.mesh);
  return surface;
}

Result<Surface> finish_surface(ParsedSurface parsed, const std::string& name, SurfaceNotes* notes,
                               std::optional<Space> where_unstated) {
  if (parsed.mesh.triangles.empty()) return make_surface(std::move(parsed.mesh), name, notes);
  const auto space = space_of(parsed, where_unstated, name);
  if (!space) return tl::unexpected(space.error());
  convert_to_lps(*space, parsed.mesh);  // a half turn: what points along the winding still does
  const std::size_t split = parsed.stated.hash.empty() ? join_split_vertices(parsed.mesh) : 0;
  if (split > 0 && notes != nullptr)
    notes->sentences.push_back(name + ": " + std::to_string(split) +
                               " vertices stood where others stand and were joined with them");
  auto surface = make_surface(std::move(parsed.mesh), name, notes);
  if (!surface) return surface;
  if (!surface->closed && parsed.normals.against > parsed.normals.along && notes != nullptr)
    notes->sentences.push_back(name +
                               ": its normals point against the order of its triangles' corners, which is "
                               "what counts: its outside may be the side you call inside");
  const std::string& stated = parsed.stated.hash;
  if (!stated.empty() && stated != surface->identity.hash)
    return fail(name + ": states the hash " + stated.substr(0, 32) + " but its triangles have " +
                surface->identity.hash + "; it was changed after it was written, so export it again");
  surface->identity.series = parsed.stated.series;
  surface->identity.frame_of_reference = parsed.stated.frame_of_reference;
  return surface;
}

Result<Surface> read_surface(const std::filesystem::path& file, SurfaceNotes* notes,
                             std::optional<Space> where_unstated) {
  const auto bytes = read_whole_file(file, kLargestSurfaceBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  auto parsed = parse(*bytes, file);
  if (!parsed) return tl::unexpected(parsed.error());
  return finish_surface(*std::move(parsed), file.string(), notes, where_unstated);
}

}  // namespace orcart
