// orcart calibrate time: the tracker's lag against the video, from a recording of movements.
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "firmware-host/files/whole_file.hpp"
#include "tools/calibration/time_command.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Examples:\n  orcart calibrate time moves.orcart --pattern chessboard:14x10:3mm --out sync.toml --page "
    "time.html\n"
    "  orcart calibrate time moves.orcart\n"
    "  orcart calibrate time FOLDER --scope scope.toml --pattern chessboard:14x10:3mm\n\n"
    "Record with the cart (orcartd --session moves.orcart): rest the scope before a board or anything with "
    "texture that stands still,\n"
    "hold the pedal for four seconds, and in them move the scope to and fro, swiftly, with short rests; five "
    "times or more.\n"
    "FOLDER: frames.csv (image,time_ms: mid-exposure), poses.csv (time_ms,m00,...,m23) and the pictures; "
    "both "
    "times on one clock.";

struct Arguments {
  TimeCommand command;
  std::string pattern, out, page;
  double search_ms = 250;
  bool json = false;
};

Result<void> run(Arguments& arguments) {
  if (!arguments.pattern.empty()) {
    const auto pattern = parse_pattern(arguments.pattern);
    if (!pattern) return tl::unexpected(pattern.error());
    arguments.command.pattern = *pattern;
  }
  arguments.command.search_s = 1e-3 * arguments.search_ms;
  const Progress told = [](std::size_t done, std::size_t all, const std::string& what) {
    if (done % 10 == 0 || done == all)
      std::fprintf(stderr, "\r\033[K  %zu/%zu %s%s", done, all, what.c_str(), done == all ? "\r\033[K" : "");
  };
  const auto calibration =
      calibrate_time(arguments.command, arguments.json || ::isatty(STDERR_FILENO) != 1 ? Progress{} : told);
  if (!calibration) return tl::unexpected(calibration.error());
  if (!arguments.page.empty())
    if (auto written = write_whole_file(arguments.page, time_page(*calibration)); !written) return written;
  if (!arguments.out.empty())
    if (auto written = write_whole_file(arguments.out, sync_snippet(*calibration)); !written) return written;
  std::fputs((arguments.json ? time_json(*calibration) : time_text(*calibration)).c_str(), stdout);
  return {};
}

}  // namespace

void add_time(CLI::App& calibrate, int& exit_code) {
  CLI::App* verb =
      calibrate.add_subcommand("time", "The tracker against the video, from a recording of movements");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("recording", arguments->command.recording, "a session, *.orcart, or a folder")->required();
  verb->add_option("--pattern", arguments->pattern,
                   "the board in view, as for `orcart calibrate camera`; without it features are followed");
  verb->add_option("--scope", arguments->command.scope, "the passport, for a folder");
  verb->add_option("--search-ms", arguments->search_ms, "lags up to this, either way, are tried")
      ->check(CLI::Range(40.0, 500.0))
      ->capture_default_str();
  verb->add_option("--out", arguments->out, "a file for the lines that belong into cart.toml");
  verb->add_option("--page", arguments->page, "also one HTML page with the misfit, movement by movement");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = run(*arguments);
    if (!done) std::fprintf(stderr, "orcart calibrate time: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
