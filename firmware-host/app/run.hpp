// One run of the cart, from its configuration to its report.
#pragma once

#include "firmware-host/app/options.hpp"

namespace orcart {

/// Exit codes of orcartd.
enum class ExitCode : int { ok = 0, failed = 1, usage = 2, configuration = 3, device = 4 };

/// Says what it does on stderr, ends with the summary on stdout. Ends early and cleanly on SIGINT and
/// SIGTERM.
ExitCode run(const Options& options);

}  // namespace orcart
