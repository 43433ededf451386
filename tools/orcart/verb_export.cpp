// orcart export: a session's captures as pictures and tables.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <numbers>

#include "tools/evaluate/session/session_export.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Into the folder: capture-0001.png, ... as they were painted; views.csv with the camera's poses on the "
    "surface, how far the\nlight post was turned and how fast the scope moved, where the session knows it, "
    "for\n"
    "orcart paint and evaluate; poses.csv with the scope's marker in the patient's reference, for orcart "
    "calibrate handeye\n"
    "--poses-in reference; scope.toml and registration.toml as they were used. What was undone is left "
    "out.\n\n"
    "Example:\n"
    "  orcart export procedure.orcart --out procedure\n"
    "  orcart paint --surface ventricle.ply --seen-from inside --scope procedure/scope.toml --views "
    "procedure/views.csv --out painted.glb\n";

struct Arguments {
  ExportCommand command;
  bool json = false;
};

int run(const Arguments& arguments) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto bar = [&](const std::string& what, double done) {
    if (terminal) std::fprintf(stderr, "\r\033[K%s %3.0f %%", what.c_str(), 100 * done);
  };
  const auto report = export_session(arguments.command, bar);
  if (terminal) std::fputs("\r\033[K", stderr);
  if (!report) {
    std::fprintf(stderr, "orcart export: %s\n", report.error().message.c_str());
    return 1;
  }
  const double turn_deg = report->turn_rad * 180 / std::numbers::pi;
  const std::string out = arguments.command.out.string();
  if (arguments.json) {
    std::printf("{\"captures\": %zu, \"undone\": %zu, \"turn_deg\": %.4f, \"turned\": %s, \"out\": %s}\n",
                report->captures, report->undone, turn_deg, report->turned ? "true" : "false",
                json::text(out).c_str());
    return 0;
  }
  std::printf("%zu captures (%zu more were undone): %s\n", report->captures, report->undone, out.c_str());
  if (turn_deg != 0) std::printf("scope.toml is turned by %.1f degrees, as the light post was\n", turn_deg);
  if (report->turned) std::printf("views.csv tells how far the light post was turned in each picture\n");
  return 0;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("export", "A session's captures as pictures and tables");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("session", arguments->command.session, "the session's file, *.orcart")->required();
  verb->add_option("--out", arguments->command.out, "a folder that is not there yet")->required();
  verb->add_flag("--json", arguments->json, "the summary as one JSON object");
  verb->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace orcart
