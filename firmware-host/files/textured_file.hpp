// A painted surface for other programs: OBJ with its MTL and PNG, PLY with its PNG, or GLB.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// What is written; lent for the call.
struct TexturedSurface {
  const Surface& surface;
  /// Per triangle, a place in the picture for each corner: 0..1, origin bottom left.
  std::span<const std::array<Eigen::Vector2f, 3>> corners_uv;
  int width_texels = 0, height_texels = 0;
  std::span<const std::uint8_t> rgba;  ///< straight alpha, row 0 on top
};

/// `file` ends in .obj (NAME.mtl and NAME.png come beside it) or .ply (NAME.png, named in a
/// TextureFile comment; the places are the vertices' texture_u and texture_v, which most programs know:
/// vertices on a seam are repeated behind the surface's own, an element `seam` says which one each repeats,
/// and read_surface joins them again) or .glb (one file, see textured_glb.hpp). The picture is opaque: what
/// has no paint is grey. Millimetres, LPS, said in a comment with the surface's identity. All files are made
/// ready before the first appears under its name; on an error none does.
Result<void> write_textured(const std::filesystem::path& file, const TexturedSurface& textured);

/// The names of all files that write_textured makes of `file`, itself first.
std::vector<std::filesystem::path> textured_files(const std::filesystem::path& file);

}  // namespace orcart
