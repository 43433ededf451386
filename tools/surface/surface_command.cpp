// Runs the steps of `orcart surface` on a volume.
#include "tools/surface/surface_command.hpp"

#include <chrono>
#include <utility>

#include "tools/surface/slice_pictures.hpp"

namespace orcart {

namespace {

constexpr int kSteps = 6;

Result<Surface> closed_surface(ExtractedSurface& extracted, const Volume& volume, const std::string& name) {
  auto surface = make_surface(std::move(extracted.mesh), name);
  if (!surface) return surface;
  if (!surface->closed)
    return fail(name + ": its surface did not stay closed with " +
                std::to_string(surface->mesh.triangles.size()) + " triangles; more --triangles are expected");
  surface->identity.series = volume.series;
  surface->identity.frame_of_reference = volume.frame_of_reference;
  return surface;
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

Result<void> add_page(const SurfaceCommand& command, const Volume& volume, const TriangleMesh& mesh,
                      SurfaceReport& report) {
  auto pictures = pictures_of(mesh);
  if (!pictures) return tl::unexpected(pictures.error());
  report.pictures = *std::move(pictures);
  auto slices = draw_slices(volume, mesh, command.region.seeds_mm.front());
  for (SlicePicture& slice : slices) {
    char caption[120];
    std::snprintf(caption, sizeof caption,
                  "slice across %c at %.1f mm (number %d), through the seed; yellow: the surface",
                  slice.across, slice.place_mm, slice.index);
    report.pictures.push_back({.name = std::string("slice-") + slice.across + ".png",
                               .caption = caption,
                               .picture = std::move(slice.picture)});
  }
  return write_page(command.output.page, report);
}

}  // namespace

Result<SurfaceReport> make_surface_file(const SurfaceCommand& command, const SurfaceProgress& progress) {
  const auto began = std::chrono::steady_clock::now();
  const std::string name = command.volume.path.string();
  if (auto sound = check_output(command.output); !sound) return tl::unexpected(sound.error());
  progress(1, kSteps, "reading " + name);
  auto volume = read_volume(command.volume);
  if (!volume) return tl::unexpected(volume.error());
  progress(2, kSteps, "growing the region in " + std::to_string(volume->lattice.voxels()) + " voxels");
  if (auto smooth = denoise(*volume, command.denoise_mm, name); !smooth)
    return tl::unexpected(smooth.error());
  auto region = grow_region(*volume, command.region, name);
  if (!region) return tl::unexpected(region.error());
  SurfaceReport report{.source = name, .kind = volume->kind, .notes = volume->notes};
  append(report.notes, region->notes);
  report.growth = GrowthReport{.lowest = command.region.lowest,
                               .highest = command.region.highest,
                               .curve_ml = region->curve.volume_ml};
  progress(3, kSteps, "closing and smoothing it");
  auto soft = soften(*std::move(region), volume->lattice, command.soft, name);
  if (!soft) return tl::unexpected(soft.error());
  report.growth->region_ml = soft->volume_ml;
  report.growth->filled_voxels = soft->filled_voxels;
  if (command.output.page.empty()) volume->values = {};
  progress(4, kSteps, "cutting, smoothing and thinning out its surface");
  auto extracted = extract_surface(soft->mask, command.extraction);
  if (!extracted) return fail(name + ": " + extracted.error().message);
  soft->mask = {};
  report.triangles_before = extracted->cut_triangles;
  report.smoothing_max_mm = extracted->smoothing_max_mm;
  report.thinning = extracted->thinning;
  progress(5, kSteps, "measuring and writing " + command.output.out.string());
  const auto surface = closed_surface(*extracted, *volume, name);
  if (!surface) return tl::unexpected(surface.error());
  if (auto written = write_surface(*surface, command.output, report); !written)
    return tl::unexpected(written.error());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (command.output.page.empty()) return report;
  progress(6, kSteps, "drawing " + (command.output.page / "surface.html").string());
  if (auto page = add_page(command, *volume, surface->mesh, report); !page)
    return tl::unexpected(page.error());
  return report;
}

}  // namespace orcart
