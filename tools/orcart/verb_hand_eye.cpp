// orcart calibrate handeye: where the camera sits on its marker.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/calibration/hand_eye_command.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart calibrate handeye image*.png --poses poses.csv --pattern chessboard:18x16:2mm "
    "--scope scope.toml\n\n"
    "poses.csv: name,m00,...,m23, the scope marker in the tracker (or in a reference beside the board), mm; "
    "by the pictures' names or in\n"
    "their order. The passport is written back with X_SC unless --out names another.";

struct Arguments {
  HandEyeCommand command;
  std::string pattern, scope, out, page;
  bool json = false;
};

/// The views left out as the paper states its errors: light of the board's origin, painted by the others.
struct MappingError {
  double mean_mm = 0, sd_mm = 0, worst_mm = 0;
};
MappingError mapping_error(const std::vector<double>& left_out_mm) {
  MappingError error;
  const auto count = static_cast<double>(left_out_mm.size());
  for (const double off : left_out_mm) {
    error.mean_mm += off / count;
    error.worst_mm = std::max(error.worst_mm, off);
  }
  for (const double off : left_out_mm)
    error.sd_mm += (off - error.mean_mm) * (off - error.mean_mm) / std::max(1.0, count - 1);
  error.sd_mm = std::sqrt(error.sd_mm);
  return error;
}

/// Row by row, a twist in C; null where it is not known.
std::string covariance_json(const HandEyeCalibration& c) {
  if (!c.spread) return "null";
  std::vector<std::string> rows;
  rows.reserve(6);
  for (int i = 0; i < 6; ++i) rows.push_back(json::numbers(Twist(c.spread->hand_eye.row(i))));
  return json::list(rows);
}

std::string answer(const HandEyeCalibration& c, bool as_json) {
  const MappingError mapping = mapping_error(c.left_out_mm);
  const Eigen::Vector3d &closed = c.closed_form.X_SC.translation_mm, &refined = c.refined.X_SC.translation_mm;
  std::vector<std::string> notes, views;
  for (const std::string& note : c.notes) notes.push_back(json::text(note));
  for (std::size_t i = 0; i < c.names.size(); ++i)
    views.push_back("{\"image\": " + json::text(c.names[i]) +
                    ", \"scatter_mm\": " + json::number(c.refined.scatters_mm[i]) + ", \"left_out_mm\": " +
                    (i < c.left_out_mm.size() ? json::number(c.left_out_mm[i]) : "null") + "}");
  if (as_json)
    return "{\"X_SC\": " + json::pose(c.refined.X_SC) +
           ",\n \"closed_form_X_SC\": " + json::pose(c.closed_form.X_SC) +
           ",\n \"scatter_mm\": " + json::number(c.refined.scatter_mm) +
           ", \"closed_form_scatter_mm\": " + json::number(c.closed_form.scatter_mm) +
           ", \"leave_one_out_mm\": " + json::number(c.leave_one_out_mm.value_or(NAN)) +
           ", \"least_left_out_mm\": " + json::number(c.least_left_out_mm) +
           ", \"tracker_floor_mm\": " + json::number(c.floor_mm) +
           ",\n \"mapping_error\": {\"mean_mm\": " + json::number(mapping.mean_mm) +
           ", \"sd_mm\": " + json::number(mapping.sd_mm) + ", \"max_mm\": " + json::number(mapping.worst_mm) +
           ", \"n\": " + std::to_string(c.left_out_mm.size()) + "}" +
           ", \"covariance\": " + covariance_json(c) +
           ", \"misfit\": " + (c.spread ? json::number(c.spread->misfit) : "null") +
           ", \"rms_px\": " + json::number(c.refined.rms_px) + ",\n \"views\": " + json::list(views) +
           ",\n \"notes\": " + json::list(notes) + "}\n";
  std::string out =
      json::format("closed form  camera at %.3f %.3f %.3f mm on the marker, board scatter %.3f mm RMS\n",
                   closed.x(), closed.y(), closed.z(), c.closed_form.scatter_mm);
  out += json::format(
      "refined      camera at %.3f %.3f %.3f mm on the marker, board scatter %.3f mm RMS, %.3f px; leaving "
      "each view out in turn %s\n",
      refined.x(), refined.y(), refined.z(), c.refined.scatter_mm, c.refined.rms_px,
      c.leave_one_out_mm ? json::format("%.3f mm", *c.leave_one_out_mm).c_str()
                         : "is not told by three views");
  if (c.spread) {
    const Eigen::Vector3d mm = c.spread->hand_eye.diagonal().head<3>().cwiseSqrt(),
                          mrad = 1e3 * c.spread->hand_eye.diagonal().tail<3>().cwiseSqrt();
    out += json::format(
        "known to +- %.3f %.3f %.3f mm and %.2f %.2f %.2f mrad in the camera's axes (one standard "
        "deviation); "
        "the poses scatter by %.2f of the declared noise\n",
        mm.x(), mm.y(), mm.z(), mrad.x(), mrad.y(), mrad.z(), std::sqrt(c.spread->misfit));
  }
  out += json::format("the tracker's declared noise alone would scatter it by %.3f mm\n", c.floor_mm);
  out += json::format("no hand-eye pose leaves less than %.3f mm with views left out\n", c.least_left_out_mm);
  if (!c.left_out_mm.empty())
    out += json::format("as a mapping error of one point: mean %.2f, s.d. %.2f, max %.2f mm, n %zu\n",
                        mapping.mean_mm, mapping.sd_mm, mapping.worst_mm, c.left_out_mm.size());
  for (std::size_t i = 0; i < c.names.size(); ++i)
    out += json::format("  %-32s %.3f mm", c.names[i].c_str(), c.refined.scatters_mm[i]) +
           (i < c.left_out_mm.size() ? json::format(", left out %.3f mm\n", c.left_out_mm[i]) : "\n");
  for (const std::string& note : c.notes) out += "note: " + note + "\n";
  return out;
}

Result<void> run(Arguments& arguments) {
  const auto pattern = parse_pattern(arguments.pattern);
  if (!pattern) return tl::unexpected(pattern.error());
  arguments.command.pattern = *pattern;
  const auto scope = read_scope(arguments.scope);
  if (!scope) return tl::unexpected(scope.error());
  const auto calibration = calibrate_hand_eye(arguments.command, *scope, {});
  if (!calibration) return tl::unexpected(calibration.error());
  if (!arguments.page.empty())
    if (auto written =
            write_whole_file(arguments.page, hand_eye_page(*calibration, answer(*calibration, false)));
        !written)
      return written;
  if (auto written = write_scope(arguments.out.empty() ? arguments.scope : arguments.out, calibration->scope);
      !written)
    return written;
  std::fputs(answer(*calibration, arguments.json).c_str(), stdout);
  return {};
}

}  // namespace

void add_hand_eye(CLI::App& calibrate, int& exit_code) {
  CLI::App* verb = calibrate.add_subcommand("handeye", "Where the camera sits on its marker");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("images", arguments->command.images, "pictures of the pattern")->required();
  verb->add_option("--poses", arguments->command.poses, "the marker's poses")->required();
  verb->add_option("--pattern", arguments->pattern, "as for `orcart calibrate camera`")->required();
  verb->add_option("--scope", arguments->scope, "the scope's passport")->required();
  verb->add_option("--out", arguments->out, "the passport to write; the one read unless told");
  verb->add_option("--marker-noise", arguments->command.noise.marker_mm, "of one marker in 3-D, mm RMS")
      ->check(CLI::Range(0.001, 5.0))
      ->capture_default_str();
  verb->add_option("--marker-radius", arguments->command.noise.body_radius_mm,
                   "of the body's markers about their middle, mm")
      ->check(CLI::Range(5.0, 500.0))
      ->capture_default_str();
  verb->add_option("--depth-ratio", arguments->command.noise.depth_ratio,
                   "marker noise along the sensor's z against x and y; with --poses-in tracker")
      ->check(CLI::Range(1.0, 20.0))
      ->capture_default_str();
  static const std::vector<std::pair<std::string, PosesIn>> frames{{"tracker", PosesIn::tracker},
                                                                   {"reference", PosesIn::reference}};
  verb->add_option("--poses-in", arguments->command.noise.poses_in,
                   "tracker (the default), or reference: a marker body beside the board")
      ->transform(one_of(frames));
  verb->add_option("--page", arguments->page, "also one HTML page with residuals in each picture");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = run(*arguments);
    if (!done) std::fprintf(stderr, "orcart calibrate handeye: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
