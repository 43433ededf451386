// Where a tracked thing rested: stretches of places that stay together.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace orcart {

struct RestSearch {
  std::size_t frames = 20;  ///< a rest lasts at least so many
  double within_mm = 2;     ///< of the mean of those before
};

struct Rest {
  std::size_t first = 0, count = 0;
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
};

/// In the order of time; rests do not overlap.
std::vector<Rest> rests_of(const std::vector<Eigen::Vector3d>& places_mm, const RestSearch& search);

/// Mean square of the steps from one place to the next over the variance about the mean, over all axes: 2 for
/// independent noise, near 0 for a slow movement (von Neumann 1941). 0 where all places are one.
double successive_ratio(const std::vector<Eigen::Vector3d>& places_mm, const Rest& rest);

}  // namespace orcart
