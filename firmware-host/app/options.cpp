// The command line of orcartd.
#include "firmware-host/app/options.hpp"

#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

#include "firmware-host/app/command_line.hpp"

namespace orcart {

Result<Nanos> duration_from(const std::string& text) {
  const std::string accepted =
      "\"" + text + "\" is no length of time; 30s, 2m, 1500ms or 1h are accepted, up to a day";
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const std::map<std::string, double> units{{"", 1},   {"s", 1},    {"ms", 1e-3},
                                            {"m", 60}, {"min", 60}, {"h", 3600}};
  const auto unit = units.find(end);
  if (end == text.c_str() || unit == units.end() || !std::isfinite(number)) return fail(accepted);
  const double length_s = number * unit->second;
  if (length_s <= 0 || length_s > 86'400) return fail(accepted);
  return from_seconds(length_s);
}

tl::expected<Options, int> read_options(int argc, char** argv) {
  CLI::App app{"orcartd: the resident program of the cart.\nResearch use only; not a medical device."};
  app.footer("Example:\n  orcartd --cart share/carts/demo.toml --panel png --report out/demo --for 30s");
  Options options;
  std::string run_for;
  app.failure_message(in_a_sentence);
  app.set_version_flag("--version", ORCART_VERSION);
  app.add_option("--cart", options.cart, "the cart's configuration")->required();
  app.add_option("--panel", options.panel,
                 "png: pictures beside the report; window: a preview on this screen; kms: the [panel] of the "
                 "cart, no desktop "
                 "running; none")
      ->transform(one_of<PanelKind>({{"png", PanelKind::png},
                                     {"window", PanelKind::window},
                                     {"kms", PanelKind::kms},
                                     {"none", PanelKind::none}}));
  app.add_option("--clock", options.clock,
                 "real: the wall clock; simulated: as fast as it can, the same every time")
      ->transform(one_of<ClockKind>({{"real", ClockKind::real}, {"simulated", ClockKind::simulated}}));
  app.add_option("--for", run_for,
                 "how long, e.g. 30s; without it until stopped or the simulated procedure ends");
  app.add_option_function<Medium>(
         "--medium", [&options](const Medium& medium) { options.medium = medium; },
         "what the scope is used in: air, water or saline; painting is blocked where the passport says "
         "another")
      ->transform(
          one_of<Medium>({{"air", Medium::air}, {"water", Medium::water}, {"saline", Medium::saline}}));
  app.add_option_function<double>(
         "--turn", [&options](const double& deg) { options.turn_rad = deg * std::numbers::pi / 180; },
         "degrees by which the picture has turned since the passport was made (orcart turn tells it by the "
         "notch)")
      ->check(CLI::Range(-360.0, 360.0));
  app.add_option("--session", options.session,
                 "keep every capture in this *.orcart file, which must not exist yet; in a folder, in a new "
                 "one named by "
                 "the time of the start");
  app.add_option("--report", options.report_dir,
                 "write pictures, report.html and report.json into this folder");
  app.add_option(
      "--trace", options.trace,
      "write what every thread, frame and capture did into this file, for https://ui.perfetto.dev");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(exit_code_of(app, error));
  }
  if (!run_for.empty()) {
    auto length = duration_from(run_for);
    if (!length) {
      std::fprintf(stderr, "orcartd: --for %s\n", length.error().message.c_str());
      return tl::unexpected(2);
    }
    options.run_for = *length;
  }
  return options;
}

}  // namespace orcart
