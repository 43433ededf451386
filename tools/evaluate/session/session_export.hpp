// A session's captures as the files that every other verb reads.
#pragma once

#include <filesystem>

#include "tools/evaluate/evaluate_command.hpp"

namespace orcart {

struct ExportCommand {
  std::filesystem::path session;
  std::filesystem::path out;  ///< a folder that is not there yet
};

struct ExportReport {
  std::size_t captures = 0, undone = 0;
  double turn_rad = 0;  ///< of an angled scope's light post, as it was told before the session
  bool turned = false;  ///< it was turned on the way as well: views.csv has turn_rad
};

/// Into the folder: capture-0001.png, ...; views.csv with X_MC; poses.csv with the scope marker in the
/// patient's reference, X_RS = X_RM X_MC X_CS; scope.toml as it was used, turned as was told
/// before the session, and views.csv with each picture's turn since then where it was followed;
/// registration.toml. What was undone is left out. The folder appears whole or not at all.
Result<ExportReport> export_session(const ExportCommand& command, const EvaluateProgress& progress);

}  // namespace orcart
