// Options that more than one part of `orcart evaluate` takes.
#pragma once

#include <numbers>

#include <CLI/CLI.hpp>

#include "tools/evaluate/stated_errors.hpp"

namespace orcart {

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
