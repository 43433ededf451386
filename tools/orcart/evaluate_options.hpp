// Options that more than one part of `orcart evaluate` takes.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/evaluate/stated_errors.hpp"

namespace orcart {

/// `model` outlives the parsing of `verb`.
inline void add_time_deviation(CLI::App& verb, ErrorModel& model) {
  verb.add_option_function<double>(
          "--time-deviation-ms", [&model](double ms) { model = with_time(model, 1e-3 * ms); },
          "standard deviation of tracker against video, as `orcart calibrate time` tells; 2 is assumed")
      ->check(CLI::Range(0.0, 100.0));
}

}  // namespace orcart
