// orcart calibrate medium: a passport made in air, for use in fluid.
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/calibration/medium.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart calibrate medium --scope air.toml --medium saline --out saline.toml\n\n"
    "For a flat window. Calibrating in the fluid itself is better: what the conversion adds in doubt is told "
    "and "
    "written into the\npassport's residuals. The window's place comes from orcart calibrate tip, or "
    "--window-mm.";

struct Arguments {
  std::string scope, out, page;
  Medium medium = Medium::saline;
  double window_mm = 0;
  MediumDoubt doubt;
  bool doubt_told = false;
  bool json = false;
};

std::string answer(const Arguments& arguments, const ScopeModel& air, const MediumConversion& fluid,
                   bool as_json) {
  const Lens& lens = fluid.scope.lens;
  if (as_json)
    return "{\"viewpoint_mm\": " + json::number(fluid.viewpoint_mm) +
           ", \"viewpoint_rms_px\": " + json::number(fluid.viewpoint_rms_px) +
           ", \"viewpoint_worst_px\": " + json::number(fluid.viewpoint_worst_px) +
           ", \"added_px\": " + json::number(fluid.added_px) +
           ", \"added_mm_at_20\": " + json::number(fluid.added_mm) +
           ", \"fx_px\": " + json::number(lens.fx_px) + ", \"fy_px\": " + json::number(lens.fy_px) + "}\n";
  return json::format("f %.2f %.2f px for %.2f %.2f in air; the optical centre moves back by %.3f mm\n",
                      lens.fx_px, lens.fy_px, air.lens.fx_px, air.lens.fy_px, fluid.viewpoint_mm) +
         json::format("one viewpoint leaves %.3f px RMS, %.3f px at most, between 5 and 60 mm\n",
                      fluid.viewpoint_rms_px, fluid.viewpoint_worst_px) +
         json::format(
             "added to the passport's doubt: %.3f px, %.3f mm at 20 mm (window +- %.2f mm, index +- %.4f)\n",
             fluid.added_px, fluid.added_mm, arguments.doubt.window_mm, arguments.doubt.index);
}

Result<void> run(Arguments& arguments) {
  auto air = read_scope(arguments.scope);
  if (!air) return tl::unexpected(air.error());
  if (arguments.window_mm > 0) {
    air->X_CE.translation_mm = {0, 0, arguments.window_mm};
    air->window_covariance = Eigen::Vector3d(0, 0, arguments.doubt.window_mm).cwiseAbs2().asDiagonal();
  } else if (air->window_covariance && !arguments.doubt_told) {
    arguments.doubt.window_mm = std::sqrt((*air->window_covariance)(2, 2));
  }
  const auto fluid = to_fluid(*air, arguments.medium, arguments.doubt);
  if (!fluid) return fail(arguments.scope + ": " + fluid.error().message);
  if (!arguments.page.empty())
    if (auto written = write_whole_file(arguments.page,
                                        medium_page(*air, *fluid, answer(arguments, *air, *fluid, false)));
        !written)
      return written;
  if (auto written = write_scope(arguments.out, fluid->scope); !written) return written;
  std::fputs(answer(arguments, *air, *fluid, arguments.json).c_str(), stdout);
  return {};
}

}  // namespace

void add_medium(CLI::App& calibrate, int& exit_code) {
  CLI::App* verb = calibrate.add_subcommand("medium", "A passport made in air, for use in fluid");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  static const std::vector<std::pair<std::string, Medium>> media{
      {"air", Medium::air}, {"water", Medium::water}, {"saline", Medium::saline}};
  verb->add_option("--scope", arguments->scope, "the passport, made in air")->required();
  verb->add_option("--medium", arguments->medium, "water or saline")->transform(one_of(media))->required();
  verb->add_option("--window-mm", arguments->window_mm, "from the optical centre to the window's outside, mm")
      ->check(CLI::Range(0.01, 50.0));
  const CLI::Option* doubt =
      verb->add_option("--window-doubt", arguments->doubt.window_mm,
                       "its standard deviation, mm; the passport's own where --window-mm is not given")
          ->check(CLI::Range(0.0, 20.0))
          ->capture_default_str();
  verb->add_option("--index-doubt", arguments->doubt.index, "standard deviation of the fluid's index")
      ->check(CLI::Range(0.0, 0.2))
      ->capture_default_str();
  verb->add_option("--out", arguments->out, "the passport for the fluid")->required();
  verb->add_option("--page", arguments->page, "also one HTML page with the lens in both media");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, doubt, &exit_code] {
    arguments->doubt_told = doubt->count() > 0;
    const auto done = run(*arguments);
    if (!done) std::fprintf(stderr, "orcart calibrate medium: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
