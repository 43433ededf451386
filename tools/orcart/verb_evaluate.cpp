// orcart evaluate: the paper's Table 1, from one command.
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "tools/evaluate/evaluate_command.hpp"
#include "tools/evaluate/share_folder.hpp"
#include "tools/orcart/evaluate_options.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {

namespace {

constexpr const char* kFooter =
    "Every set-up is drawn anew: a view, 6 fiducials, noise on each marker of scope and reference, on each\n"
    "fiducial, on hand-eye, lens, medium and time. A landmark's error is the 3-D distance between the point "
    "its\n"
    "light came from and the point it is painted on. --noise: vega (0.12 mm RMS of a marker's 3-D error), "
    "paper\n"
    "(0.25), both, or a number in mm. With --views the recorded pictures are compared with each other, "
    "without\n"
    "landmarks. Surface, registration and reference markers are the demo's unless all three are told, scope "
    "and\nits markers unless both are.\n\n"
    "Examples:\n"
    "  orcart evaluate --page out/evaluation\n"
    "  orcart evaluate --noise vega --setups 200 --json\n"
    "  orcart evaluate --surface s.ply --registration registration.toml --reference-rom reference.rom \\\n"
    "    --scope scope.toml --scope-rom scope.rom --seen-from outside --views views.csv\n"
    "  orcart evaluate map --views views.csv --out predicted.glb\n"
    "  orcart evaluate session procedure.orcart --surface s.ply\n"
    "  orcart evaluate board image*.png --poses poses.csv --pattern chessboard:18x16:2mm\n";

struct Arguments {
  EvaluateCommand command;
  std::string noise = "both", seen_from = "inside";
  bool json = false;
};

Result<void> take_noise(Arguments& arguments) {
  auto& noises = arguments.command.noises;
  noises.clear();
  if (arguments.noise == "vega" || arguments.noise == "both") noises.emplace_back("vega", 0.12);
  if (arguments.noise == "paper" || arguments.noise == "both") noises.emplace_back("paper", 0.25);
  if (!noises.empty()) return {};
  char* end = nullptr;
  const double mm = std::strtod(arguments.noise.c_str(), &end);
  if (end == arguments.noise.c_str() || *end != '\0' || !(mm > 0 && mm <= 5))
    return fail("--noise is \"" + arguments.noise +
                "\"; vega, paper, both or millimetres up to 5 are accepted");
  noises.emplace_back("marker noise", mm);
  return {};
}

int run(Arguments& arguments) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto bar = [&](const std::string& what, double done) {
    if (!terminal) return;
    constexpr int kWidth = 30;
    const int full = static_cast<int>(kWidth * done);
    std::fprintf(stderr, "\r\033[K%s [%.*s%*s] %3.0f %%", what.c_str(), full,
                 "##############################", kWidth - full, "", 100 * done);
  };
  arguments.command.seen_from = arguments.seen_from == "outside" ? SeenFrom::outside : SeenFrom::inside;
  EvaluateCommand& c = arguments.command;
  auto taken = take_noise(arguments);
  if (taken)
    taken = told_demo_files("orcart evaluate",
                            {c.surface, c.scope, c.registration, c.scope_rom, c.reference_rom});
  const auto report = taken ? evaluate(arguments.command, bar) : tl::unexpected(taken.error());
  if (terminal) std::fputs("\r\033[K", stderr);
  if (!report) {
    std::fprintf(stderr, "orcart evaluate: %s\n", report.error().message.c_str());
    return 1;
  }
  std::fputs((arguments.json ? json_of(*report) : text_of(*report)).c_str(), stdout);
  if (!arguments.command.page.empty() && !arguments.json)
    std::printf("page     %s\n", (arguments.command.page / "evaluation.html").string().c_str());
  return 0;
}

}  // namespace

void add_evaluate(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("evaluate", "The paper's Table 1: tracking, tip and mapping errors");
  auto arguments = std::make_shared<Arguments>();
  EvaluateCommand& command = arguments->command;
  verb->footer(kFooter);
  verb->add_option("--surface", command.surface, "a PLY, STL, OBJ or mz3 surface; the demo's unless told");
  verb->add_option("--scope", command.scope, "the calibration passport; the demo's unless told");
  verb->add_option("--registration", command.registration, "where the reference sits: its X_MR");
  verb->add_option("--scope-rom", command.scope_rom, "markers on the scope");
  verb->add_option("--reference-rom", command.reference_rom, "markers of the patient's reference");
  verb->add_option("--seen-from", arguments->seen_from, "the side the scope looks at: inside or outside")
      ->check(CLI::IsMember({"inside", "outside"}))
      ->capture_default_str();
  verb->add_option("--noise", arguments->noise, "vega, paper, both, or mm RMS a marker")
      ->capture_default_str();
  verb->add_option("--setups", command.simulation.setups, "independent set-ups")
      ->check(CLI::Range(2, 1'000'000))
      ->capture_default_str();
  verb->add_option("--landmarks", command.simulation.landmarks, "of each set-up's capture")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  verb->add_option("--seed", command.simulation.seed, "the same seed draws the same set-ups")
      ->capture_default_str();
  verb->add_option("--threads", command.simulation.threads)->check(CLI::Range(1, 256))->capture_default_str();
  verb->add_option("--pairs", command.pairs, "simulated pairs of captures that are compared")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  verb->add_option("--views", command.views,
                   "views.csv: recorded pictures to compare in place of simulated ones");
  verb->add_option("--page", command.page, "a folder for a page with pictures and figures");
  add_deviations(*verb, arguments->command.simulation.model);
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  add_evaluate_map(*verb, exit_code);
  add_evaluate_session(*verb, exit_code);
#ifdef ORCART_WITH_CALIBRATION
  add_evaluate_board(*verb, exit_code);
#endif
  refuse_options_before(*verb);
  verb->callback([verb, arguments, &exit_code] {
    if (verb->get_subcommands().empty()) exit_code = run(*arguments);
  });
}

}  // namespace orcart
