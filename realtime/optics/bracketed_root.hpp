// A root of a rising function inside a bracket: Newton's step where it stays inside, a halving where it does
// not.
#pragma once

#include <cmath>

namespace orcart {

struct ValueAndSlope {
  double value = 0;
  double slope = 0;
};

/// x in [low, high] at which a function that rises there meets `target`; an end of the bracket where it never
/// does. At most 100 evaluations; ends when a step changes nothing.
template <class Function>
double bracketed_root(const Function& function, double low, double high, double target) {
  double x = std::fmin(std::fmax(target, low), high);
  for (int i = 0; i < 100; ++i) {
    const ValueAndSlope at = function(x);
    (at.value < target ? low : high) = x;
    double next = x - (at.value - target) / at.slope;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (next == x) break;
    x = next;
  }
  return x;
}

}  // namespace orcart
