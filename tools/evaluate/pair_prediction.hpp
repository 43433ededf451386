// How far apart two captures of one place must be expected to paint it.
#pragma once

#include "tools/evaluate/consistency.hpp"
#include "tools/evaluate/propagation.hpp"

namespace orcart {

/// What two captures of one set-up do not share.
inline constexpr ComponentSet kApart{true, true, false, true, true, true, true, true};

/// A capture with the scene and the errors at the turn of its light post. Lent.
struct JudgedCapture {
  const EvaluationScene& scene;
  const ErrorModel& model;
  Capture capture;
};

/// RMS over the patches of what propagation expects between the two, mm; 0 without patches.
double predicted_apart_mm(const std::vector<Eigen::Vector3d>& fiducials_M_mm, const PairConsistency& pair,
                          const JudgedCapture& first, const JudgedCapture& second);

}  // namespace orcart
