// Logarithmic bins and percentiles of times.
#include <algorithm>
#include <cmath>

#include "firmware-host/report/run_report.hpp"

namespace orcart {
namespace {
constexpr double kLowestMs = 1e-3;
constexpr double kDecades = 6.0;  // 1 us .. 1 s
}  // namespace

int distribution_bin(double ms) {
  if (ms <= kLowestMs) return 0;
  const int bin = static_cast<int>(std::log10(ms / kLowestMs) / kDecades * kDistributionBins);
  return std::clamp(bin, 0, kDistributionBins - 1);
}

double bin_lower_ms(int bin) {
  return kLowestMs * std::pow(10.0, kDecades * bin / kDistributionBins);
}

void fill_from_samples(Distribution& distribution, std::vector<double> samples_ms) {
  distribution.bins.assign(kDistributionBins, 0);
  distribution.samples = samples_ms.size();
  if (samples_ms.empty()) return;
  std::sort(samples_ms.begin(), samples_ms.end());
  const auto at = [&](double q) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(samples_ms.size())));
    return samples_ms[std::max<std::size_t>(rank, 1) - 1];
  };
  distribution.p50_ms = at(0.5);
  distribution.judged_quantile = 0.5;
  for (const double q : {0.9, 0.99, 0.999}) {
    if (static_cast<double>(samples_ms.size()) * (1 - q) >= 99.9) distribution.judged_quantile = q;
  }
  distribution.judged_ms = at(distribution.judged_quantile);
  distribution.max_ms = samples_ms.back();
  for (const double ms : samples_ms) {
    ++distribution.bins[static_cast<std::size_t>(distribution_bin(ms))];
    if (distribution.bound_ms > 0 && ms > distribution.bound_ms) ++distribution.over_bound;
  }
}

}  // namespace orcart
