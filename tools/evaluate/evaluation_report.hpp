// What `orcart evaluate` tells: the paper's Table 1 beside ours, the budget, the prediction, consistency.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/evaluate/consistency.hpp"
#include "tools/evaluate/simulation.hpp"
#include "tools/mesh/surface_report.hpp"

namespace orcart {

/// One tracker's noise, and what came of it.
struct NoiseRun {
  std::string name;
  ErrorModel model;
  SimulationResult result;
};

/// Two captures that see one place.
struct PairReport {
  std::string first, second;
  PairConsistency found;
  double predicted_mm = 0;  ///< RMS by propagation, without what both captures share
  double true_mm = -1;      ///< median of the real difference of their errors; negative: not known
  bool alarm() const { return !found.patches.empty() && found.median_mm > 2 * predicted_mm; }
};

struct EvaluationReport {
  std::string surface, surface_hash, scope, seen_from;
  ErrorModel model;  ///< with what passport and registration state
  std::uint64_t seed = 1;
  int setups = 0;
  std::vector<NoiseRun> runs;
  std::vector<PairReport> pairs;
  std::vector<std::string> notes;
  std::vector<CaptionedPicture> pictures;
  double seconds = 0;
};

std::string text_of(const EvaluationReport& report);
std::string json_of(const EvaluationReport& report);
/// DIR/evaluation.html with its pictures beside it, and DIR/evaluation.json.
Result<void> write_page(const std::filesystem::path& dir, const EvaluationReport& report);

}  // namespace orcart
