// orcart register: the patient's reference in the mesh's space, from fiducials.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "tools/mesh/mesh_pictures.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/register_points.hpp"
#include "tools/registration/report_page.hpp"
#include "tools/registration/sequence_file.hpp"
#include "tools/registration/surface_refine.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart register ct.fcsv pointer.csv --surface brain.ply --fle 0.4 --target 12,-30,55 --out "
    "registration.toml\n\n"
    "FIXED: fiducials in the volume; MOVING: the same, touched with the pointer, in the patient's reference; "
    "or a PLUS recording\n"
    "(.igs.mha) of a stylus that rested on each, with --stylus-tip. In a MOVING list of 3D Slicer, R, A, S "
    "as "
    "Slicer shows\n"
    "them are x, y, z of the reference. FRE only tells outliers; the predicted "
    "error comes from --fle.";

struct Arguments {
  std::string fixed, moving, out, surface;
  std::optional<Space> space;
  RegistrationTask task;
  std::vector<double> target, stylus_tip;
  StylusNames names;
  std::string surface_points, picture, page;
  double surface_error_mm = 0.5;
  bool json = false;
};

Result<std::vector<NamedPoint>> moving_points(const Arguments& arguments, std::vector<std::string>& notes) {
  if (!is_sequence_name(arguments.moving)) return read_measured_points(arguments.moving, &notes);
  if (arguments.stylus_tip.size() != 3)
    return fail(arguments.moving + ": a recording needs the stylus tip in its marker, --stylus-tip x,y,z");
  const auto sequence = read_sequence(arguments.moving);
  if (!sequence) return tl::unexpected(sequence.error());
  auto rests =
      stylus_rests(*sequence, {arguments.stylus_tip[0], arguments.stylus_tip[1], arguments.stylus_tip[2]}, {},
                   arguments.names);
  if (!rests) return fail(arguments.moving + ": " + rests.error().message);
  return rests;
}

/// What the surface adds: refinement by points on it, and the predicted error over all of it.
struct OnSurface {
  std::optional<SurfaceRefinement> refinement;
  std::optional<SurfaceTre> tre;
  std::string figure;  ///< HTML, where a page is wanted
};

std::string surface_json(const OnSurface& on) {
  std::string out;
  if (on.refinement)
    out += ",\n \"surface_points\": {\"used\": " + std::to_string(on.refinement->used) +
           ", \"left_out\": " + std::to_string(on.refinement->left_out) +
           ", \"before_mm\": " + json::number(on.refinement->before_mm) +
           ", \"after_mm\": " + json::number(on.refinement->after_mm) +
           ", \"moved_mm\": " + json::number(on.refinement->moved_mm) + "}";
  if (on.tre)
    out += ",\n \"surface_tre\": {\"mean_mm\": " + json::number(on.tre->mean_mm) +
           ", \"p95_mm\": " + json::number(on.tre->p95_mm) +
           ", \"max_mm\": " + json::number(on.tre->worst_mm) +
           ", \"max_at_mm\": " + json::numbers(on.tre->worst_at_mm) + "}";
  return out;
}

std::string surface_text(const OnSurface& on) {
  std::string out;
  if (on.refinement)
    out += json::format(
        "surface points: %zu used, %zu far off left out; %.2f mm RMS from the surface, %.2f before; the "
        "fiducials' "
        "middle moved by %.2f mm\n",
        on.refinement->used, on.refinement->left_out, on.refinement->after_mm, on.refinement->before_mm,
        on.refinement->moved_mm);
  if (on.tre)
    out += json::format("over the surface: mean %.2f, p95 %.2f, at most %.2f mm RMS at %.1f %.1f %.1f\n",
                        on.tre->mean_mm, on.tre->p95_mm, on.tre->worst_mm, on.tre->worst_at_mm.x(),
                        on.tre->worst_at_mm.y(), on.tre->worst_at_mm.z());
  return out;
}

/// The surface from two sides, coloured by the predicted error: green 0, yellow half, red `worst_mm`.
Result<void> draw_tre(const Registration& registration, const TriangleMesh& mesh, double worst_mm,
                      const std::filesystem::path& file) {
  const auto rays = RayScene::create(mesh);
  if (!rays) return tl::unexpected(rays.error());
  const MeshColour colour = [&](const RayHit&, const Eigen::Vector3f& place) {
    const auto part = static_cast<float>(std::clamp(
        predicted_tre_mm(registration, place.cast<double>()) / std::max(1e-9, worst_mm), 0.0, 1.0));
    return Eigen::Vector3f(std::min(1.0F, 2 * part), std::min(1.0F, 2 - 2 * part), 0.15F);
  };
  const Picture left = draw_mesh(mesh, *rays, {.from = {1, 0, 0}}, colour),
                front = draw_mesh(mesh, *rays, {.from = {0, -1, 0}}, colour);
  Picture both{.width_px = left.width_px + front.width_px, .height_px = left.height_px};
  for (int y = 0; y < both.height_px; ++y)
    for (const Picture* one : {&left, &front}) {
      const auto row = static_cast<std::ptrdiff_t>(4) * one->width_px;
      both.rgba.insert(both.rgba.end(), one->rgba.begin() + y * row, one->rgba.begin() + (y + 1) * row);
    }
  return write_png(file, both.width_px, both.height_px, both.rgba);
}

/// The same picture as a part of a page.
Result<std::string> tre_figure(const Registration& registration, const TriangleMesh& mesh, double worst_mm) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("orcart-tre-" + std::to_string(::getpid()) + ".png");
  if (auto drawn = draw_tre(registration, mesh, worst_mm, file); !drawn) return tl::unexpected(drawn.error());
  const auto bytes = read_whole_file(file, 64U << 20U);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (!bytes) return tl::unexpected(bytes.error());
  return "<h2>Expected error over the surface</h2><p>Green: none. Yellow: half. Red: the most, " +
         json::format("%.2f mm RMS", worst_mm) + ".</p><img style='max-width:100%' src='" +
         picture_data_url("png", *bytes) + "'>";
}

Result<OnSurface> use_surface(const Arguments& arguments, const TriangleMesh& mesh,
                              Registration& registration) {
  OnSurface on;
  if (!arguments.surface_points.empty()) {
    const auto points = read_measured_points(arguments.surface_points, &registration.notes);
    if (!points) return tl::unexpected(points.error());
    SurfaceTask task{.error_mm = arguments.surface_error_mm};
    for (const NamedPoint& point : *points) task.points_R_mm.push_back(point.mm);
    const auto refinement = refine_on_surface(registration, mesh, task);
    if (!refinement) return fail(arguments.surface_points + ": " + refinement.error().message);
    on.refinement = *refinement;
  }
  on.tre = tre_over_surface(registration, mesh);
  if (!arguments.page.empty()) {
    auto figure = tre_figure(registration, mesh, on.tre->worst_mm);
    if (!figure) return tl::unexpected(figure.error());
    on.figure = std::move(*figure);
  }
  if (arguments.picture.empty()) return on;
  if (auto drawn = draw_tre(registration, mesh, on.tre->worst_mm, arguments.picture); !drawn)
    return tl::unexpected(drawn.error());
  return on;
}

std::string answer_json(const Registration& r, const Eigen::Vector3d& target_mm, const OnSurface& on) {
  std::vector<std::string> points, notes;
  for (const RegisteredPoint& p : r.points)
    points.push_back("{\"fixed\": " + json::text(p.fixed) + ", \"moving\": " + json::text(p.moving) +
                     ", \"error_mm\": " + json::number(p.error_mm) + "}");
  for (const std::string& note : r.notes) notes.push_back(json::text(note));
  return "{\"X_MR\": " + json::pose(r.X_MR) + ",\n \"fre_mm\": " + json::number(r.fre_mm) +
         ", \"fle_mm\": " + json::number(r.fle_mm) +
         ", \"predicted_tre_mm\": " + json::number(predicted_tre_mm(r, target_mm)) +
         ", \"target_mm\": " + json::numbers(target_mm) +
         ", \"outlier\": " + (r.outlier.empty() ? "null" : json::text(r.outlier)) + surface_json(on) +
         ",\n \"points\": " + json::list(points) + ",\n \"notes\": " + json::list(notes) + "}\n";
}

std::string answer_text(const Registration& r, const Eigen::Vector3d& target_mm, const OnSurface& on) {
  std::string out =
      json::format("FRE %.4f mm RMS over %zu points (a test for outliers, not the error at the target)\n",
                   r.fre_mm, r.points.size());
  for (const RegisteredPoint& p : r.points)
    out += json::format("  %-12s with %-12s %7.3f mm\n", p.fixed.c_str(), p.moving.c_str(), p.error_mm);
  out += json::format(
      "expected error at %.1f %.1f %.1f: %.2f mm RMS, from a declared fiducial error of %.2f mm; rigid error "
      "only, tissue shifts\n",
      target_mm.x(), target_mm.y(), target_mm.z(), predicted_tre_mm(r, target_mm), r.fle_mm);
  out += surface_text(on);
  for (const std::string& note : r.notes) out += "note: " + note + "\n";
  return out;
}

Result<void> run(Arguments& arguments) {
  std::vector<std::string> notes;
  auto fixed = read_points(arguments.fixed, arguments.space, &notes);
  if (!fixed) return tl::unexpected(fixed.error());
  auto moving = moving_points(arguments, notes);
  if (!moving) return tl::unexpected(moving.error());
  arguments.task.fixed = std::move(*fixed);
  arguments.task.moving = std::move(*moving);
  auto registration = register_points(arguments.task);
  if (!registration) return fail(arguments.moving + ": " + registration.error().message);
  registration->notes.insert(registration->notes.begin(), notes.begin(), notes.end());
  if (arguments.surface.empty() && !(arguments.surface_points.empty() && arguments.picture.empty()))
    return fail("--surface-points and --picture belong to a surface; --surface is wanted too");
  RegistrationFile file{.surface_hash = "unstated"};
  OnSurface on;
  Eigen::Vector3d target = registration->centroid_mm;
  if (!arguments.surface.empty()) {
    const auto surface = read_surface(arguments.surface);
    if (!surface) return tl::unexpected(surface.error());
    file.surface_hash = surface->identity.hash;
    auto used = use_surface(arguments, surface->mesh, *registration);
    if (!used) return tl::unexpected(used.error());
    on = *used;
    target.setZero();
    for (const auto& vertex : surface->mesh.vertices_mm)
      target += vertex.cast<double>() / static_cast<double>(surface->mesh.vertices_mm.size());
  }
  if (arguments.target.size() == 3) target = {arguments.target[0], arguments.target[1], arguments.target[2]};
  file.X_MR = registration->X_MR;
  file.fre_mm = registration->fre_mm;
  file.covariance = twist_covariance(*registration);
  file.predicted_tre_mm = predicted_tre_mm(*registration, target);
  if (!arguments.page.empty())
    if (auto written = write_whole_file(
            arguments.page, register_page(*registration, answer_text(*registration, target, on), on.figure));
        !written)
      return written;
  if (auto written = write_registration(arguments.out, file); !written) return written;
  std::fputs(
      (arguments.json ? answer_json(*registration, target, on) : answer_text(*registration, target, on))
          .c_str(),
      stdout);
  return {};
}

}  // namespace

void add_register(CLI::App& app, int& exit_code) {
  CLI::App* verb =
      app.add_subcommand("register", "The patient's reference in the mesh's space, from fiducials");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("fixed", arguments->fixed, "fiducials in the volume: points.csv, .fcsv or .mrk.json")
      ->required();
  verb->add_option("moving", arguments->moving,
                   "the same, measured: points.csv, .fcsv or .mrk.json, or a recording .igs.mha")
      ->required();
  static const std::vector<std::pair<std::string, Space>> spaces{{"LPS", Space::lps}, {"RAS", Space::ras}};
  verb->add_option_function<Space>(
          "--space", [arguments](const Space& space) { arguments->space = space; },
          "axes of FIXED where the file does not state them: LPS or RAS")
      ->transform(one_of(spaces));
  static const std::vector<std::pair<std::string, Pairing>> pairings{
      {"names", Pairing::by_name}, {"given", Pairing::by_order}, {"unknown", Pairing::unknown}};
  verb->add_option_function<Pairing>(
          "--order", [arguments](const Pairing& pairing) { arguments->task.pairing = pairing; },
          "names, given or unknown; by names where they agree, else as given")
      ->transform(one_of(pairings));
  verb->add_option("--fle", arguments->task.fle_mm,
                   "fiducial localisation error, mm RMS, declared or pooled over patients")
      ->check(CLI::Range(0.01, 20.0))
      ->capture_default_str();
  verb->add_option("--target", arguments->target, "x,y,z in LPS, mm, where the expected error is told")
      ->delimiter(',')
      ->expected(3);
  verb->add_option("--stylus-tip", arguments->stylus_tip, "x,y,z in the stylus's marker, mm, for a recording")
      ->delimiter(',')
      ->expected(3);
  verb->add_option("--stylus", arguments->names.stylus, "the stylus's name in a recording")
      ->capture_default_str();
  verb->add_option("--reference", arguments->names.reference, "the reference's name in a recording")
      ->capture_default_str();
  verb->add_option("--surface", arguments->surface,
                   "the surface that the registration belongs to; its hash is written");
  verb->add_option(
      "--surface-points", arguments->surface_points,
      "points touched on the surface, in the reference's space: the registration is refined with them");
  verb->add_option("--surface-error", arguments->surface_error_mm,
                   "standard deviation of their distance from the surface, mm")
      ->check(CLI::Range(0.01, 20.0))
      ->capture_default_str();
  verb->add_option("--picture", arguments->picture, "a PNG of the surface, coloured by the expected error");
  verb->add_option("--page", arguments->page, "also one HTML page with the errors of fiducials and targets");
  verb->add_option("--out", arguments->out, "registration.toml")->required();
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = run(*arguments);
    if (!done) std::fprintf(stderr, "orcart register: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
