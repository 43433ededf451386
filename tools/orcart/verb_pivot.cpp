// orcart pivot: where a pointer's tip lies in its marker.
#include <cstdio>
#include <memory>

#include "firmware-host/files/whole_file.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/pivot.hpp"
#include "tools/registration/sequence_file.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart pivot sweep.csv --out pointer.toml\n\n"
    "Poses of the marker in the tracker while the tip stands in a divot and the pointer is tilted to all "
    "sides: poses.csv, rows of 12 or\n"
    "16 numbers with or without a name or time stamp, a folder of 4x4 matrices, or a PLUS recording "
    "(.igs.mha): "
    "there --stylus and\n"
    "--reference name the two ends of the transform, StylusToTracker unless told.";

constexpr double kLargestRms_mm = 10;  ///< beyond it the tip was not in one place

struct Arguments {
  std::string poses, out, page, name = "pointer";
  StylusNames names{.reference = "Tracker"};
  bool json = false;
};

std::string solution_json(const PivotSolution& s) {
  return "{\"tip_mm\": " + json::numbers(s.tip_mm) + ", \"pivot_mm\": " + json::numbers(s.pivot_mm) +
         ", \"rms_mm\": " + json::number(s.rms_mm) +
         ", \"rms_component_mm\": " + json::number(s.rms_component_mm) +
         ", \"worst_mm\": " + json::number(s.worst_mm) + ", \"poses\": " + std::to_string(s.poses) +
         ", \"deviation_mm\": " + json::numbers(s.deviation_mm) + "}";
}

std::string solution_text(const char* which, const PivotSolution& s) {
  return json::format(
      "%s %4zu poses: tip %.4f %.4f %.4f mm in the marker (+- %.3f %.3f %.3f), RMS %.3f mm, worst %.3f mm\n",
      which, s.poses, s.tip_mm.x(), s.tip_mm.y(), s.tip_mm.z(), s.deviation_mm.x(), s.deviation_mm.y(),
      s.deviation_mm.z(), s.rms_mm, s.worst_mm);
}

std::string tool_text(const Arguments& arguments, const PivotFit& fit) {
  return "# A pointer: its tip in its marker, mm.\nname = " + json::text(arguments.name) +
         "\ntip_mm = " + json::numbers(fit.robust.tip_mm) +
         "\ndeviation_mm = " + json::numbers(fit.robust.deviation_mm) +
         "\nrms_mm = " + json::number(fit.robust.rms_mm) + "\nposes = " + std::to_string(fit.robust.poses) +
         "\n";
}

std::string answer(const PivotFit& fit, bool as_json) {
  if (as_json)
    return "{\"robust\": " + solution_json(fit.robust) + ",\n \"all\": " + solution_json(fit.all) +
           ",\n \"sweep_rad\": " + json::number(fit.sweep_rad) +
           ", \"inlier_mm\": " + json::number(fit.inlier_mm) + "}\n";
  return solution_text("agreeing", fit.robust) + solution_text("all     ", fit.all) +
         json::format("sweep of %.0f degrees; poses farther off than %.2f mm were left out\n",
                      fit.sweep_rad * 57.29578, fit.inlier_mm);
}

Result<PosesFile> sweep(const Arguments& arguments) {
  if (!is_sequence_name(arguments.poses)) return read_poses(arguments.poses);
  const auto sequence = read_sequence(arguments.poses);
  if (!sequence) return tl::unexpected(sequence.error());
  auto poses = stylus_poses(*sequence, arguments.names);
  if (!poses) return fail(arguments.poses + ": " + poses.error().message);
  return PosesFile{.poses = *std::move(poses), .notes = {}};
}

Result<void> run(const Arguments& arguments) {
  const auto poses = sweep(arguments);
  if (!poses) return tl::unexpected(poses.error());
  for (const std::string& note : poses->notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  const auto fit = fit_pivot(poses->poses);
  if (!fit) return fail(arguments.poses + ": " + fit.error().message);
  if (fit->robust.rms_mm > kLargestRms_mm)
    return fail(
        arguments.poses +
        json::format(": even the poses that agree lie %.1f mm RMS from one tip; a pointer whose tip stands "
                     "still while it is tilted is accepted",
                     fit->robust.rms_mm));
  if (!arguments.page.empty())
    if (auto written = write_whole_file(arguments.page, pivot_page(poses->poses, *fit, answer(*fit, false)));
        !written)
      return written;
  if (auto written = write_whole_file(arguments.out, tool_text(arguments, *fit)); !written) return written;
  std::fputs(answer(*fit, arguments.json).c_str(), stdout);
  return {};
}

}  // namespace

void add_pivot(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("pivot", "Where a pointer's tip lies in its marker");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("poses", arguments->poses, "the sweep: a file, a folder or a recording .igs.mha")
      ->required();
  verb->add_option("--stylus", arguments->names.stylus, "the pointer's name in a recording")
      ->capture_default_str();
  verb->add_option("--reference", arguments->names.reference, "in a recording: what its poses are in")
      ->capture_default_str();
  verb->add_option("--name", arguments->name, "the pointer's name")->capture_default_str();
  verb->add_option("--out", arguments->out, "the tool's file")->required();
  verb->add_option("--page", arguments->page, "also one HTML page with each pose's distance");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = run(*arguments);
    if (!done) std::fprintf(stderr, "orcart pivot: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
