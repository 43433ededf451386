// What `orcart evaluate` does: reads the scene, simulates, compares captures, and reports.
#pragma once

#include <functional>
#include <optional>

#include "tools/evaluate/evaluation_report.hpp"

namespace orcart {

struct EvaluateCommand {
  std::filesystem::path surface, scope, registration;
  std::filesystem::path scope_rom, reference_rom;
  SeenFrom seen_from = SeenFrom::inside;
  SimulationRequest simulation;                        ///< its marker noise is replaced by each of `noises`
  std::vector<std::pair<std::string, double>> noises;  ///< name, RMS of a marker's 3-D error in mm
  int pairs = 3;                ///< simulated pairs of captures that are compared; 0: none
  std::filesystem::path views;  ///< recorded pictures with their poses, compared one with the next
  std::filesystem::path page;   ///< a folder for the page; empty: none
};

/// Told what is going on and how much of it is done, 0..1.
using EvaluateProgress = std::function<void(const std::string& what, double done)>;

Result<EvaluationReport> evaluate(const EvaluateCommand& command, const EvaluateProgress& progress);

}  // namespace orcart
