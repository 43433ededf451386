// A rest grows as long as the next place is near the mean so far.
#include "tools/registration/rests.hpp"

namespace orcart {

std::vector<Rest> rests_of(const std::vector<Eigen::Vector3d>& places_mm, const RestSearch& search) {
  std::vector<Rest> rests;
  for (std::size_t start = 0; start + search.frames <= places_mm.size();) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t end = start;
    for (; end < places_mm.size(); ++end) {
      const auto count = static_cast<double>(end - start);
      if (end > start && (places_mm[end] - sum / count).norm() > search.within_mm) break;
      sum += places_mm[end];
    }
    const std::size_t length = end - start;
    if (length < search.frames) {
      ++start;
      continue;
    }
    rests.push_back({.first = start, .count = length, .mean_mm = sum / static_cast<double>(length)});
    start = end;
  }
  return rests;
}

double successive_ratio(const std::vector<Eigen::Vector3d>& places_mm, const Rest& rest) {
  double steps2 = 0, spread2 = 0;
  for (std::size_t i = rest.first; i < rest.first + rest.count; ++i) {
    spread2 += (places_mm[i] - rest.mean_mm).squaredNorm();
    if (i > rest.first) steps2 += (places_mm[i] - places_mm[i - 1]).squaredNorm();
  }
  return spread2 > 0 ? steps2 / spread2 : 0;
}

}  // namespace orcart
