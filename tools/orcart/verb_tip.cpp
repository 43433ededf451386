// orcart calibrate tip: the distal window before the optical centre, from known distances.
#include <cstdio>
#include <memory>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/calibration/tip.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart calibrate tip at-*.png --distances 10,15,20,25,30 --pattern chessboard:14x10:3mm "
    "--scope scope.toml\n\n"
    "Stand the scope at measured distances before the board, from the window to the board along the scope's "
    "axis; name them in the\npictures' order. The passport is written back with X_CE unless --out names "
    "another.";

struct Arguments {
  TipCommand command;
  std::string pattern, scope, out, page;
  bool json = false;
};

std::string answer(const TipCalibration& c, bool as_json) {
  const TipFit& fit = c.fit;
  std::vector<std::string> views, notes;
  std::string out = json::format(
      "the window lies %.3f +- %.3f mm before the optical centre (95 %%: %.3f to %.3f; of the deviation the "
      "views "
      "leave %.3f, the lens %.3f)\nerror of a distance, each view left out in turn: mean %.3f, s.d. %.3f, "
      "max %.3f "
      "mm over %zu views\nit is the point in which the camera's axis leaves the window: nothing is measured "
      "across",
      fit.window_mm, c.deviation_mm, fit.window_mm - 1.96 * c.deviation_mm,
      fit.window_mm + 1.96 * c.deviation_mm, fit.deviation_mm, c.lens_mm, fit.mean_mm, fit.sd_mm,
      fit.worst_mm, c.views.size());
  out += c.middle_mm
             ? json::format("; the ray of the circle's middle leaves it %.2f mm beside\n", *c.middle_mm)
             : "\n";
  for (std::size_t i = 0; i < c.views.size(); ++i) {
    const TipView& v = c.views[i];
    out += json::format("  %-32s known %8.3f mm, from the optical centre %8.3f mm, error %+.3f mm\n",
                        v.name.c_str(), v.known_mm, v.camera_mm, fit.errors_mm[i]);
    views.push_back("{\"image\": " + json::text(v.name) + ", \"known_mm\": " + json::number(v.known_mm) +
                    ", \"camera_mm\": " + json::number(v.camera_mm) +
                    ", \"error_mm\": " + json::number(fit.errors_mm[i]) + "}");
  }
  for (const std::string& note : fit.notes) {
    out += "note: " + note + "\n";
    notes.push_back(json::text(note));
  }
  if (!as_json) return out;
  return "{\"X_CE\": " + json::pose(c.scope.X_CE) + ",\n \"window_mm\": " + json::number(fit.window_mm) +
         ", \"deviation_mm\": " + json::number(c.deviation_mm) +
         ", \"deviation_by_views_mm\": " + json::number(fit.deviation_mm) +
         ", \"deviation_by_lens_mm\": " + json::number(c.lens_mm) +
         ", \"circle_middle_beside_mm\": " + json::number(c.middle_mm.value_or(NAN)) +
         ", \"covariance\": " + json::numbers(Eigen::VectorXd(c.scope.window_covariance->reshaped())) +
         ", \"scale\": " + json::number(fit.scale) +
         ", \"scale_deviation\": " + json::number(fit.scale_deviation) +
         ", \"mean_mm\": " + json::number(fit.mean_mm) + ", \"sd_mm\": " + json::number(fit.sd_mm) +
         ", \"max_mm\": " + json::number(fit.worst_mm) + ",\n \"views\": " + json::list(views) +
         ",\n \"notes\": " + json::list(notes) + "}\n";
}

Result<void> run(Arguments& arguments) {
  const auto pattern = parse_pattern(arguments.pattern);
  if (!pattern) return tl::unexpected(pattern.error());
  arguments.command.pattern = *pattern;
  const auto scope = read_scope(arguments.scope);
  if (!scope) return tl::unexpected(scope.error());
  const auto calibration = calibrate_tip(arguments.command, *scope, {});
  if (!calibration) return tl::unexpected(calibration.error());
  if (!arguments.page.empty())
    if (auto written = write_whole_file(arguments.page, tip_page(*calibration, answer(*calibration, false)));
        !written)
      return written;
  if (auto written = write_scope(arguments.out.empty() ? arguments.scope : arguments.out, calibration->scope);
      !written)
    return written;
  std::fputs(answer(*calibration, arguments.json).c_str(), stdout);
  return {};
}

}  // namespace

void add_tip(CLI::App& calibrate, int& exit_code) {
  CLI::App* verb = calibrate.add_subcommand("tip", "The distal window, from known distances to a board");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("images", arguments->command.images, "pictures of the pattern")->required();
  verb->add_option("--distances", arguments->command.distances_mm,
                   "mm from the window to the board, one a picture: 10,20,30")
      ->delimiter(',')
      ->required();
  verb->add_option("--pattern", arguments->pattern, "as for `orcart calibrate camera`")->required();
  verb->add_option("--scope", arguments->scope, "the scope's passport")->required();
  verb->add_option("--out", arguments->out, "the passport to write; the one read unless told");
  verb->add_option("--page", arguments->page, "also one HTML page with distances and errors");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = run(*arguments);
    if (!done) std::fprintf(stderr, "orcart calibrate tip: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
