// A thousand independent set-ups: the paper's three errors, their budget, and the prediction held against
// them.
#pragma once

#include <functional>

#include "realtime/base/result.hpp"
#include "tools/evaluate/draw.hpp"
#include "tools/evaluate/statistics.hpp"

namespace orcart {

struct SimulationRequest {
  ErrorModel model;
  int setups = 1000;
  int landmarks = 8;  ///< of each set-up's one capture
  int trials = 5;     ///< of tracking and tip, as in the paper
  std::uint64_t seed = 1;
  int threads = 2;
};

/// How often the predicted ellipse of 95 % holds the error.
struct Coverage {
  std::size_t points = 0, covered = 0;
  double share() const {
    return points == 0 ? 0 : static_cast<double>(covered) / static_cast<double>(points);
  }
};

struct SimulationResult {
  Statistics tracking;  ///< distance of a repeated position of the scope body from the mean of its trials
  Statistics tip;       ///< a known distance between two places of the tip, one-dimensional
  Statistics tip_3d;    ///< of the tip in the patient's reference, all of it
  Statistics mapping;   ///< of a landmark: where its light is painted against where it came from, 3-D
  std::array<Statistics, kComponents> alone;  ///< mapping, with one component only
  Statistics predicted_rms;                   ///< of the landmarks, by propagation
  Coverage coverage;       ///< of the error along the surface, where it lands on the same sheet
  Coverage coverage_all;   ///< of all landmarks, those that jump a fold too
  std::size_t lost = 0;    ///< landmarks whose light misses the surface
  std::size_t jumped = 0;  ///< landmarks whose light lands on another fold
  std::vector<double> mapping_errors_mm;
  double seconds = 0;
};

/// Set-ups are drawn from (seed, number) alone: the result does not depend on the number of threads.
/// `progress` is told from one thread how many are done. Refuses a scene in which no view finds room.
Result<SimulationResult> simulate(const EvaluationScene& scene, const SimulationRequest& request,
                                  const std::function<void(int done)>& progress = {});

}  // namespace orcart
