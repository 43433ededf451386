// orcart evaluate map: the error to be expected at each painted texel, as colours.
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "tools/evaluate/share_folder.hpp"
#include "tools/evaluate/texels/error_map.hpp"
#include "tools/orcart/evaluate_options.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "The views are painted as by `orcart paint`; at each painted texel the errors of tracker, hand-eye, "
    "registration, lens,\n"
    "medium, time and mapping are propagated through the view that painted it, and shown as a colour. "
    "Independent set-ups\n"
    "are drawn to tell whether 95 % of them land within the predicted 95 %. Surface, registration and "
    "reference markers are the "
    "demo's unless all three are told, scope and its markers unless both are.\n\n"
    "Example:\n"
    "  orcart evaluate map --surface ventricle.ply --scope scope.toml --registration registration.toml "
    "--scope-rom scope.rom \\\n"
    "    --reference-rom reference.rom --views views.csv --out predicted.glb\n";

struct Arguments {
  ErrorMapCommand command;
  std::string seen_from = "inside", out;
  bool json = false;
};

int run(Arguments& arguments) {
  ErrorMapCommand& command = arguments.command;
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto bar = [&](const std::string& what, double done) {
    if (terminal) std::fprintf(stderr, "\r\033[K%s %3.0f %%", what.c_str(), 100 * done);
  };
  command.out = arguments.out;
  command.seen_from = arguments.seen_from == "outside" ? SeenFrom::outside : SeenFrom::inside;
  const auto taken = told_demo_files(
      "orcart evaluate map",
      {command.surface, command.scope, command.registration, command.scope_rom, command.reference_rom});
  const auto report = taken ? make_error_map(command, bar) : tl::unexpected(taken.error());
  if (terminal) std::fputs("\r\033[K", stderr);
  if (!report) {
    std::fprintf(stderr, "orcart evaluate map: %s\n", report.error().message.c_str());
    return 1;
  }
  std::fputs((arguments.json ? json_of(*report) : text_of(*report)).c_str(), stdout);
  return 0;
}

}  // namespace

void add_evaluate_map(CLI::App& evaluate, int& exit_code) {
  CLI::App* verb = evaluate.add_subcommand("map", "The error to be expected at each painted texel");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  ErrorMapCommand& command = arguments->command;
  verb->add_option("--surface", command.surface, "the surface to paint");
  verb->add_option("--scope", command.scope, "the calibration passport");
  verb->add_option("--registration", command.registration, "where the reference sits: its X_MR");
  verb->add_option("--scope-rom", command.scope_rom, "markers on the scope");
  verb->add_option("--reference-rom", command.reference_rom, "markers of the patient's reference");
  verb->add_option("--views", command.views, "views.csv: pictures with their poses")->required();
  verb->add_option("--seen-from", arguments->seen_from, "the side the scope looks at: inside or outside")
      ->check(CLI::IsMember({"inside", "outside"}))
      ->capture_default_str();
  verb->add_option("--marker-noise", command.model.marker_rms_mm, "of one marker in 3-D, mm RMS")
      ->check(CLI::Range(0.001, 5.0))
      ->capture_default_str();
  verb->add_option("--texel-mm", command.texel_mm, "size of the texels")
      ->check(CLI::Range(0.02, 10.0))
      ->capture_default_str();
  verb->add_option("--setups", command.setups, "draws that the prediction is checked by")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  verb->add_option("--seed", command.seed, "the same seed draws the same set-ups")->capture_default_str();
  verb->add_option("--out", arguments->out, "NAME.obj, .ply, .glb, or a picture NAME.png")
      ->required()
      ->check(CLI::Validator(
          [](std::string& file) {
            for (const char* kind : {".obj", ".ply", ".glb", ".png"})
              if (file.ends_with(kind)) return std::string();
            return std::string("a name that ends in .obj, .ply, .glb or .png is accepted");
          },
          "NAME.obj|NAME.ply|NAME.glb|NAME.png"));
  add_deviations(*verb, arguments->command.model);
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace orcart
