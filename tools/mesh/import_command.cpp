// Reads, checks, thins out, measures and writes a surface.
#include "tools/mesh/import_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>

#include <Eigen/Geometry>

#include "tools/mesh/decimation.hpp"

namespace orcart {

namespace {

/// Nothing that an endoscope looks at is this small; a surface in metres is.
Result<void> check_unit(const TriangleMesh& mesh, const std::string& name) {
  constexpr float kSmallest_mm = 1;
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices_mm) box.extend(vertex);
  const float across = box.diagonal().norm();
  if (across >= kSmallest_mm) return {};
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", static_cast<double>(across));
  return fail(name + ": is " + text.data() +
              " mm across; that looks like metres, and millimetres are accepted");
}

/// A page's folder may be there or is made; what it lies in must be a folder that lets it.
Result<void> check_page(const std::filesystem::path& page) {
  std::error_code error;
  std::filesystem::path there = page;
  while (!there.empty() && !std::filesystem::exists(there, error)) there = there.parent_path();
  if (page.empty() || (there.empty() && ::access(".", W_OK) == 0)) return {};
  if (std::filesystem::is_directory(there, error) && ::access(there.c_str(), W_OK) == 0) return {};
  return fail((there.empty() ? std::string(".") : there.string()) +
              ": is no folder that can be written into; --page is to be one, or to be made in one");
}

Result<void> write_levels(const Surface& surface, const SurfaceOutput& output, SurfaceReport& report) {
  constexpr std::size_t kFewest = 100;
  TriangleMesh mesh = surface.mesh;
  for (int level = 1; level <= output.levels && mesh.triangles.size() / 2 >= kFewest; ++level) {
    mesh = decimate(mesh, mesh.triangles.size() / 2);
    std::filesystem::path file = output.out;
    file.replace_filename(output.out.stem().string() + "-" + std::to_string(level) + ".ply");
    auto thinner = make_surface(mesh, file.string());
    if (!thinner) return tl::unexpected(thinner.error());
    thinner->identity.series = surface.identity.series;
    thinner->identity.frame_of_reference = surface.identity.frame_of_reference;
    if (auto written = write_ply(file, *thinner); !written) return written;
    report.levels.push_back({.file = file,
                             .triangles = mesh.triangles.size(),
                             .deviation = distance_to_mesh(surface.mesh.vertices_mm, mesh)});
  }
  return {};
}

}  // namespace

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

bool is_surface_name(const std::filesystem::path& file) {
  constexpr std::array kEndings{".ply", ".stl", ".obj", ".mz3", ".vtk", ".vtp"};
  return std::find(kEndings.begin(), kEndings.end(), ending_of(file)) != kEndings.end();
}

Result<void> check_output(const SurfaceOutput& output) {
  if (output.out.extension() != ".ply")
    return fail(output.out.string() + ": the surface is written as PLY; a name ending in .ply is accepted");
  const std::filesystem::path& charts = output.charts.file;
  constexpr std::array kTextured{".ply", ".obj", ".glb"};
  if (!charts.empty() && std::find(kTextured.begin(), kTextured.end(), charts.extension()) == kTextured.end())
    return fail(charts.string() +
                ": charts are written as PLY, OBJ or GLB; a name ending in .ply, .obj or .glb is "
                "accepted");
  if (charts == output.out)
    return fail(charts.string() + ": is the surface's own name; --charts is to be another file");
  for (const auto& folder : {output.out.parent_path(), charts.parent_path()})
    if (!folder.empty() && !std::filesystem::is_directory(folder))
      return fail(folder.string() + ": is no folder; --out and --charts are to lie in one that is there");
  return check_page(output.page);
}

Result<void> write_surface(const Surface& surface, const SurfaceOutput& output, SurfaceReport& report) {
  auto figures = measure_mesh(surface.mesh);
  if (!figures) return tl::unexpected(figures.error());
  report.mesh = *figures;
  report.closed = surface.closed;
  report.identity = surface.identity;
  report.out = output.out;
  if (const auto trouble = trouble_of(report.mesh)) report.notes.push_back(*trouble);
  if (auto written = write_ply(output.out, surface); !written) return written;
  if (auto written = write_levels(surface, output, report); !written) return written;
  if (output.charts.file.empty()) return {};
  auto charts = write_charts(surface, output.charts);
  if (!charts) return tl::unexpected(charts.error());
  report.charts = *std::move(charts);
  return {};
}

Result<SurfaceReport> import_surface(const ImportCommand& command, const SurfaceReader& reader,
                                     const SurfaceProgress& progress) {
  if (auto sound = check_output(command.output); !sound) return tl::unexpected(sound.error());
  const std::string name = command.input.string();
  const auto began = std::chrono::steady_clock::now();
  progress(1, 3, "reading " + name);
  SurfaceNotes notes;
  auto surface = reader(command.input, &notes, command.where_unstated);
  if (!surface) return tl::unexpected(surface.error());
  if (auto sized = check_unit(surface->mesh, name); !sized) return tl::unexpected(sized.error());
  SurfaceReport report{.source = name,
                       .kind = "surface, " + ending_of(command.input).substr(1),
                       .triangles_before = surface->mesh.triangles.size(),
                       .notes = notes.sentences};
  if (surface->identity.series.empty()) surface->identity.series = command.input.filename().string();
  if (command.triangles > 0 && report.triangles_before > static_cast<std::size_t>(command.triangles)) {
    progress(2, 3, "thinning out");
    const SurfaceIdentity identity = surface->identity;
    const TriangleMesh before = surface->mesh;
    auto thinner = make_surface(decimate(before, static_cast<std::size_t>(command.triangles)), name);
    if (!thinner) return tl::unexpected(thinner.error());
    surface = *std::move(thinner);
    surface->identity.series = identity.series;
    surface->identity.frame_of_reference = identity.frame_of_reference;
    report.thinning = distance_to_mesh(before.vertices_mm, surface->mesh);
  }
  progress(3, 3, "measuring and writing " + command.output.out.string());
  if (auto written = write_surface(*surface, command.output, report); !written)
    return tl::unexpected(written.error());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (command.output.page.empty()) return report;
  auto pictures = pictures_of(surface->mesh);
  if (!pictures) return tl::unexpected(pictures.error());
  report.pictures = *std::move(pictures);
  if (auto page = write_page(command.output.page, report); !page) return tl::unexpected(page.error());
  return report;
}

}  // namespace orcart
