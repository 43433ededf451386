// Lanes of a test's own, and what waits in one.
#pragma once

#include <vector>

#include "firmware-host/stages/lanes.hpp"

namespace orcart::testing {

inline LaneDepths small_lanes() {
  return {.poses = 64, .pedal = 64, .frames = 16, .orders = 64, .patches = 4};
}

template <class T>
std::vector<T> all_of(SpscQueue<T>& queue) {
  std::vector<T> all;
  for (T one; queue.try_pop(one);) all.push_back(one);
  return all;
}

}  // namespace orcart::testing
