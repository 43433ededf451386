// Which of a lens's numbers the rows of its covariance stand for, in scope.toml.
#pragma once

#include <numeric>
#include <vector>

#include "realtime/optics/lens_covariance.hpp"

namespace orcart {

/// How many numbers a calibration may leave free, by model.
inline std::vector<int> lens_row_counts(LensModel model) {
  switch (model) {
    case LensModel::poly4:
      return {9};
    case LensModel::fisheye:
      return {8, 6};
    case LensModel::brown:
      break;
  }
  return {9, 8, 6, 5};
}

/// fx fy cx cy, then as many coefficients as are free; poly4: its three, then the distortion centre.
inline std::vector<int> lens_rows(LensModel model, int count) {
  if (model == LensModel::poly4) return {0, 1, 2, 3, 4, 5, 6, 9, 10};
  std::vector<int> rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// Those with a variance: the fewest of the counts above that hold them all.
inline std::vector<int> lens_rows(LensModel model, const LensCovariance& covariance) {
  std::vector<int> rows;
  for (const int count : lens_row_counts(model)) {
    const std::vector<int> fewer = lens_rows(model, count);
    double held = 0;
    for (const int i : fewer) held += covariance(i, i);
    if (rows.empty() || held == covariance.trace()) rows = fewer;
  }
  return rows;
}

}  // namespace orcart
