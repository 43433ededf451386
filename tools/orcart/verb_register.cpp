// orcart register: the patient's reference in the mesh's space, from fiducials.
#include <cstdio>
#include <map>
#include <memory>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/register_points.hpp"
#include "tools/registration/sequence_file.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart register ct.fcsv pointer.csv --surface brain.ply --fle 0.4 --target 12,-30,55 --out "
    "registration.toml\n\n"
    "FIXED: fiducials in the volume; MOVING: the same, touched with the pointer, in the patient's reference; "
    "or a PLUS recording\n"
    "(.igs.mha) of a stylus that rested on each, with --stylus-tip. FRE only tells outliers; the predicted "
    "error comes from --fle.";

struct Arguments {
  std::string fixed, moving, out, surface;
  std::optional<Space> space;
  RegistrationTask task;
  std::vector<double> target, stylus_tip;
  bool json = false;
};

Result<std::vector<NamedPoint>> moving_points(const Arguments& arguments) {
  if (!arguments.moving.ends_with(".mha")) return read_points(arguments.moving);
  if (arguments.stylus_tip.size() != 3)
    return fail(arguments.moving + ": a recording needs the stylus tip in its marker, --stylus-tip x,y,z");
  const auto sequence = read_sequence(arguments.moving);
  if (!sequence) return tl::unexpected(sequence.error());
  return stylus_rests(
      *sequence, {.tip_mm = {arguments.stylus_tip[0], arguments.stylus_tip[1], arguments.stylus_tip[2]}});
}

std::string answer_json(const Registration& r, const Eigen::Vector3d& target_mm) {
  std::vector<std::string> points, notes;
  for (const RegisteredPoint& p : r.points)
    points.push_back("{\"fixed\": " + json::text(p.fixed) + ", \"moving\": " + json::text(p.moving) +
                     ", \"error_mm\": " + json::number(p.error_mm) + "}");
  for (const std::string& note : r.notes) notes.push_back(json::text(note));
  return "{\"X_MR\": " + json::pose(r.X_MR) + ",\n \"fre_mm\": " + json::number(r.fre_mm) +
         ", \"fle_mm\": " + json::number(r.fle_mm) +
         ", \"predicted_tre_mm\": " + json::number(predicted_tre_mm(r, target_mm)) +
         ", \"target_mm\": " + json::numbers(target_mm) +
         ", \"outlier\": " + (r.outlier.empty() ? "null" : json::text(r.outlier)) +
         ",\n \"points\": " + json::list(points) + ",\n \"notes\": " + json::list(notes) + "}\n";
}

std::string answer_text(const Registration& r, const Eigen::Vector3d& target_mm) {
  std::string out =
      json::format("FRE %.4f mm RMS over %zu points (a test for outliers, not the error at the target)\n",
                   r.fre_mm, r.points.size());
  for (const RegisteredPoint& p : r.points)
    out += json::format("  %-12s with %-12s %7.3f mm\n", p.fixed.c_str(), p.moving.c_str(), p.error_mm);
  out += json::format(
      "expected error at %.1f %.1f %.1f: %.2f mm RMS, from a declared fiducial error of %.2f mm; rigid error "
      "only, tissue shifts\n",
      target_mm.x(), target_mm.y(), target_mm.z(), predicted_tre_mm(r, target_mm), r.fle_mm);
  for (const std::string& note : r.notes) out += "note: " + note + "\n";
  return out;
}

Result<void> run(Arguments& arguments) {
  auto fixed = read_points(arguments.fixed, arguments.space);
  if (!fixed) return tl::unexpected(fixed.error());
  auto moving = moving_points(arguments);
  if (!moving) return tl::unexpected(moving.error());
  arguments.task.fixed = std::move(*fixed);
  arguments.task.moving = std::move(*moving);
  const auto registration = register_points(arguments.task);
  if (!registration) return fail(arguments.moving + ": " + registration.error().message);
  RegistrationFile file{
      .X_MR = registration->X_MR, .surface_hash = "unstated", .fre_mm = registration->fre_mm};
  Eigen::Vector3d target = registration->centroid_mm;
  if (!arguments.surface.empty()) {
    const auto surface = read_surface(arguments.surface);
    if (!surface) return tl::unexpected(surface.error());
    file.surface_hash = surface->identity.hash;
    target.setZero();
    for (const auto& vertex : surface->mesh.vertices_mm)
      target += vertex.cast<double>() / static_cast<double>(surface->mesh.vertices_mm.size());
  }
  if (arguments.target.size() == 3) target = {arguments.target[0], arguments.target[1], arguments.target[2]};
  file.predicted_tre_mm = predicted_tre_mm(*registration, target);
  if (auto written = write_registration(arguments.out, file); !written) return written;
  std::fputs(
      (arguments.json ? answer_json(*registration, target) : answer_text(*registration, target)).c_str(),
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
  verb->add_option("moving", arguments->moving, "the same, measured: points.csv, or a recording .igs.mha")
      ->required();
  static const std::map<std::string, Space> spaces{{"LPS", Space::lps}, {"RAS", Space::ras}};
  verb->add_option_function<Space>(
          "--space", [arguments](const Space& space) { arguments->space = space; },
          "axes of FIXED where the file does not state them: LPS or RAS")
      ->transform(CLI::CheckedTransformer(spaces));
  static const std::map<std::string, Pairing> pairings{
      {"names", Pairing::by_name}, {"given", Pairing::by_order}, {"unknown", Pairing::unknown}};
  verb->add_option_function<Pairing>(
          "--order", [arguments](const Pairing& pairing) { arguments->task.pairing = pairing; },
          "names, given or unknown; by names where they agree, else as given")
      ->transform(CLI::CheckedTransformer(pairings));
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
  verb->add_option("--surface", arguments->surface,
                   "the surface that the registration belongs to; its hash is written");
  verb->add_option("--out", arguments->out, "registration.toml")->required();
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = run(*arguments);
    if (!done) std::fprintf(stderr, "orcart register: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
