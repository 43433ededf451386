// Surfaces in VTK's own formats: legacy .vtk and XML .vtp.
#pragma once

#include <filesystem>
#include <optional>

#include "firmware-host/files/surface_file.hpp"

namespace orcart {

/// As read_surface. The space is read from where 3D Slicer writes it: the header line of a .vtk, the field
/// SPACE of a .vtp. Strips and polygons become triangles; lines and points are left out.
Result<Surface> read_vtk_surface(const std::filesystem::path& file, SurfaceNotes* notes,
                                 std::optional<Space> where_unstated);

}  // namespace orcart
