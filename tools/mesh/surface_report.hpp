// What `orcart surface` tells of a surface, however it came: as text, as JSON and as a page with pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/files/picture_file.hpp"
#include "tools/mesh/mesh_distance.hpp"
#include "tools/mesh/mesh_figures.hpp"
#include "tools/mesh/surface_charts.hpp"

namespace orcart {

/// Only of a surface that was grown from a volume.
struct GrowthReport {
  double region_ml = 0;           ///< of the voxels, gaps and cavities filled
  std::size_t filled_voxels = 0;  ///< of which gaps and cavities
  double lowest = 0, highest = 0;
  std::vector<double> curve_ml;  ///< the region's volume while its range widens from the seeds' intensities
};

/// One thinner copy of the surface beside it.
struct SurfaceLevel {
  std::filesystem::path file;
  std::size_t triangles = 0;
  MeshDistance deviation;
};

struct CaptionedPicture {
  std::string name;  ///< of the file, without its folder
  std::string caption;
  Picture picture;
};

struct SurfaceReport {
  std::string source, kind;
  std::filesystem::path out;
  MeshFigures mesh;
  bool closed = false;
  SurfaceIdentity identity;
  std::optional<GrowthReport> growth;
  std::size_t triangles_before = 0;  ///< thinning out
  double smoothing_max_mm = 0;
  MeshDistance thinning;  ///< of the vertices before thinning out to the surface after it
  std::vector<SurfaceLevel> levels;
  std::optional<ChartReport> charts;
  std::vector<std::string> notes;
  std::vector<CaptionedPicture> pictures;  ///< only for a page
  double seconds = 0;
};

std::string text_of(const SurfaceReport& report);
std::string json_of(const SurfaceReport& report);
/// DIR/surface.html with its pictures beside it, and DIR/surface.json.
Result<void> write_page(const std::filesystem::path& dir, const SurfaceReport& report);

/// The three sides of a surface, shaded.
Result<std::vector<CaptionedPicture>> pictures_of(const TriangleMesh& mesh);

}  // namespace orcart
