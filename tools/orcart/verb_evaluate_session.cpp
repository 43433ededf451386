// orcart evaluate session: whether a session's captures fit together, pair by pair and over time.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <utility>

#include "tools/evaluate/session/session_consistency.hpp"
#include "tools/evaluate/share_folder.hpp"
#include "tools/orcart/evaluate_options.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Each capture of a session is compared with some before it, without landmarks: how far the two pictures "
    "lie apart on\n"
    "the surface, beside what the errors of the parts make one expect. Beyond twice of that is an alarm; "
    "where all pairs\n"
    "across one instant alarm, that instant is named. It cannot see a shift that both pictures share.\n\n"
    "Example:\n"
    "  orcart evaluate session procedure.orcart --surface ventricle.ply --page out/consistency\n";

struct Arguments {
  SessionCommand command;
  std::string seen_from = "inside";
  double marker_rms_mm = 0.12;
  bool json = false;
};

Result<void> take_demo_markers(SessionCommand& command) {
  for (auto& [file, name] : {std::pair{&command.scope_rom, "tools/scope.rom"},
                             std::pair{&command.reference_rom, "tools/reference.rom"}}) {
    if (!file->empty()) continue;
    auto demo = demo_file(name);
    if (!demo) return tl::unexpected(demo.error());
    *file = *std::move(demo);
    std::fprintf(stderr, "orcart evaluate session: the demo's %s\n", name);
  }
  return {};
}

int run(Arguments& arguments) {
  SessionCommand& command = arguments.command;
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto bar = [&](const std::string& what, double done) {
    if (terminal) std::fprintf(stderr, "\r\033[K%s %3.0f %%", what.c_str(), 100 * done);
  };
  command.seen_from = arguments.seen_from == "outside" ? SeenFrom::outside : SeenFrom::inside;
  command.model.marker_rms_mm = arguments.marker_rms_mm;
  const auto taken = take_demo_markers(command);
  const auto report = taken ? evaluate_session(command, bar) : tl::unexpected(taken.error());
  if (terminal) std::fputs("\r\033[K", stderr);
  if (!report) {
    std::fprintf(stderr, "orcart evaluate session: %s\n", report.error().message.c_str());
    return 1;
  }
  std::fputs((arguments.json ? json_of(*report) : text_of(*report)).c_str(), stdout);
  if (!command.page.empty() && !arguments.json)
    std::printf("page: %s\n", (command.page / "consistency.html").string().c_str());
  return 0;
}

}  // namespace

void add_evaluate_session(CLI::App& evaluate, int& exit_code) {
  CLI::App* verb = evaluate.add_subcommand("session", "Whether a session's captures fit together over time");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  SessionCommand& command = arguments->command;
  verb->add_option("session", command.session, "the session's file, *.orcart")->required();
  verb->add_option("--surface", command.surface, "the surface that was painted")->required();
  verb->add_option("--seen-from", arguments->seen_from, "the side the scope looks at: inside or outside")
      ->check(CLI::IsMember({"inside", "outside"}))
      ->capture_default_str();
  verb->add_option("--scope-rom", command.scope_rom, "markers on the scope; the demo's unless told");
  verb->add_option("--reference-rom", command.reference_rom,
                   "markers of the patient's reference; the demo's unless told");
  verb->add_option("--marker-noise", arguments->marker_rms_mm, "of one marker in 3-D, mm RMS")
      ->check(CLI::Range(0.001, 5.0))
      ->capture_default_str();
  verb->add_option("--earlier", command.earlier, "captures that each is compared with")
      ->check(CLI::Range(1, 50))
      ->capture_default_str();
  verb->add_option("--seed", command.seed, "the same seed takes the same patches")->capture_default_str();
  verb->add_option("--page", command.page, "a folder for a page with a chart over time");
  add_deviations(*verb, arguments->command.model);
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace orcart
