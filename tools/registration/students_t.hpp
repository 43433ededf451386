// How far a mean of few values may be off: the quantile of Student's t.
#pragma once

#include <array>
#include <cstddef>

namespace orcart {

/// The two-sided 95 % quantile for so many degrees of freedom; 0 counts as 1. From 13 on by the first terms
/// of its expansion, within 0.002 (Abramowitz and Stegun 1964, 26.7.5).
inline double students_t(std::size_t degrees) {
  constexpr std::array<double, 13> kTable{12.706, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447,
                                          2.365,  2.306,  2.262, 2.228, 2.201, 2.179};
  if (degrees < kTable.size()) return kTable[degrees];
  return 1.960 + 2.45 / static_cast<double>(degrees) + 2.4 / static_cast<double>(degrees * degrees);
}

}  // namespace orcart
