// `orcart surface` for a surface that was made elsewhere: checked, measured, and written as the cart likes
// it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "firmware-host/files/surface_file.hpp"
#include "tools/mesh/surface_report.hpp"

namespace orcart {

/// Told before each step: its number from 1, how many there are, and what it is.
using SurfaceProgress = std::function<void(int step, int steps, const std::string& what)>;

struct SurfaceOutput {
  std::filesystem::path out;   ///< a PLY file
  std::filesystem::path page;  ///< a folder for the page and its pictures; empty: none
  int levels = 0;              ///< thinner copies beside it: NAME-1.ply with half the triangles, and so on
  ChartOutput charts;
};

struct ImportCommand {
  std::filesystem::path input;
  std::optional<Space> where_unstated;
  int triangles = 0;  ///< thin out to at most so many; 0: leave as it is
  SurfaceOutput output;
};

/// A name's ending in lower case, with its dot.
std::string ending_of(const std::filesystem::path& file);

/// Whether a file's name says that it holds a surface: .ply, .stl, .obj, .mz3, .vtk, .vtp.
bool is_surface_name(const std::filesystem::path& file);

using SurfaceReader =
    std::function<Result<Surface>(const std::filesystem::path&, SurfaceNotes*, std::optional<Space>)>;

/// An open or self-intersecting surface is accepted and told; one in metres is refused. Writes nothing where
/// it fails.
Result<SurfaceReport> import_surface(const ImportCommand& command, const SurfaceReader& reader,
                                     const SurfaceProgress& progress);

/// Refuses a name that is no PLY's, a folder that is not there and a page that cannot be one, before any work
/// is done.
Result<void> check_output(const SurfaceOutput& output);
/// Writes the surface, its levels and the page, and completes the report with them.
Result<void> write_surface(const Surface& surface, const SurfaceOutput& output, SurfaceReport& report);

}  // namespace orcart
