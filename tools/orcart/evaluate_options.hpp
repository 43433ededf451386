// Options that more than one part of `orcart evaluate` takes.
#pragma once

#include <cstdio>
#include <numbers>
#include <string>

#include <CLI/CLI.hpp>

#include "tools/evaluate/share_folder.hpp"
#include "tools/evaluate/stated_errors.hpp"

namespace orcart {

/// take_demo_files(), and a line on the terminal's error stream about what was taken.
inline Result<void> told_demo_files(const char* verb, const EvaluatedFiles& files) {
  const auto taken = take_demo_files(files);
  if (!taken) return tl::unexpected(taken.error());
  if (!taken->empty()) std::fprintf(stderr, "%s: the demo's %s\n", verb, taken->c_str());
  return {};
}

/// An option of `verb` that stands before one of its own verbs would be taken and mean nothing there.
inline void refuse_options_before(CLI::App& verb) {
  for (CLI::App* inner : verb.get_subcommands([](CLI::App*) { return true; }))
    inner->preparse_callback([&verb, inner](std::size_t) {
      for (const CLI::Option* option : verb.get_options())
        if (option->count() > 0)
          throw CLI::ValidationError(option->get_name(), "put it behind " + inner->get_name());
    });
}

/// `model` outlives the parsing of `verb`.
inline void add_deviations(CLI::App& verb, ErrorModel& model) {
  verb.add_option_function<double>(
          "--time-deviation-ms", [&model](double ms) { model = with_time(model, 1e-3 * ms); },
          "standard deviation of tracker against video, as `orcart calibrate time` tells; 2 is assumed")
      ->check(CLI::Range(0.0, 100.0));
  verb.add_option_function<double>(
          "--turn-deviation-deg",
          [&model](double deg) { model = with_turn(model, deg * std::numbers::pi / 180); },
          "standard deviation of an angled scope's turn, by whatever tells it; else the session's, the "
          "passport's of its notch, or 0.2 assumed")
      ->check(CLI::Range(0.0, 20.0));
}

}  // namespace orcart
