// What a person types after orcartd, read and checked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

enum class PanelKind { png, window, kms, none };
enum class ClockKind { real, simulated };

struct Options {
  std::filesystem::path cart;
  PanelKind panel = PanelKind::png;
  ClockKind clock = ClockKind::real;
  std::optional<Nanos> run_for;      ///< nothing: until SIGINT or SIGTERM, or the simulated procedure's end
  std::optional<Medium> medium;      ///< what the scope is used in; over [scope] medium
  std::optional<double> turn_rad;    ///< of the light post since the passport was made; over [scope] turn_deg
  std::filesystem::path session;     ///< empty: nothing is kept
  std::filesystem::path report_dir;  ///< empty: no report
  std::filesystem::path trace;       ///< empty: nothing is traced
};

/// "30s", "2m", "1500ms", "1h"; a bare number is seconds. Positive and at most a day.
Result<Nanos> duration_from(const std::string& text);

/// The options, or the exit code where the run ends here (0 after --help and --version, 2 after a wrong line,
/// which has been explained on stderr).
tl::expected<Options, int> read_options(int argc, char** argv);

}  // namespace orcart
