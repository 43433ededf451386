// Runs the steps of `orcart surface` and measures what came out.
#include "tools/surface/surface_command.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

#include "firmware-host/files/surface_file.hpp"

namespace orcart {

namespace {

std::size_t count_edges(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      edges.push_back(static_cast<std::uint64_t>(low) << 32U | high);
    }
  std::sort(edges.begin(), edges.end());
  return static_cast<std::size_t>(std::unique(edges.begin(), edges.end()) - edges.begin());
}

SurfaceFigures measure(const Surface& surface, const GrownRegion& region) {
  const TriangleMesh& mesh = surface.mesh;
  SurfaceFigures figures{.region_ml = region.volume_ml,
                         .filled_voxels = region.filled_voxels,
                         .closed = surface.closed,
                         .vertices = mesh.vertices_mm.size(),
                         .triangles = mesh.triangles.size(),
                         .hash = surface.identity.hash};
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>(),
                          b = mesh.vertices_mm[t[1]].cast<double>(),
                          c = mesh.vertices_mm[t[2]].cast<double>();
    figures.area_mm2 += (b - a).cross(c - a).norm() / 2;
    figures.volume_ml += a.dot(b.cross(c)) / 6000;
  }
  figures.euler_number = static_cast<long>(figures.vertices) - static_cast<long>(count_edges(mesh)) +
                         static_cast<long>(figures.triangles);
  return figures;
}

}  // namespace

Result<SurfaceFigures> make_surface_file(const SurfaceCommand& command, const SurfaceProgress& progress) {
  if (command.out.extension() != ".ply")
    return fail(command.out.string() + ": the surface is written as PLY; a name ending in .ply is accepted");
  progress(1, 3, "growing the region");
  auto region = grow_region(command.region);
  if (!region) return tl::unexpected(region.error());
  progress(2, 3, "cutting, smoothing and thinning out its surface");
  auto mesh = extract_surface(region->mask, command.extraction);
  const std::string name = command.region.volume.string();
  if (!mesh) return fail(name + ": " + mesh.error().message);
  auto surface = make_surface(*std::move(mesh), name);
  if (!surface) return tl::unexpected(surface.error());
  if (!surface->closed)
    return fail(name + ": its surface did not stay closed with " +
                std::to_string(surface->mesh.triangles.size()) + " triangles; more --triangles are expected");
  surface->identity.series = command.region.volume.filename().string();
  progress(3, 3, "writing " + command.out.string());
  if (auto written = write_ply(command.out, *surface); !written) return tl::unexpected(written.error());
  return measure(*surface, *region);
}

}  // namespace orcart
