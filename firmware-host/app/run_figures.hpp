// From a cart that has stopped to the figures of its report.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/app/cart.hpp"
#include "firmware-host/report/run_report.hpp"

namespace orcart {

struct RunFacts {
  const CartConfig& config;
  const Patient& patient;
  Instant started{};
  Instant ended{};
  double resident_mb = 0;
  std::vector<CoveragePoint> coverage;  ///< as it grew
};

/// Everything but the painting errors and the pictures. The GL context must be current: coverage and the
/// painting's hash are read from it.
RunReport figures_of(Cart& cart, const RunFacts& facts);

/// Resident memory of this process, MB (VmRSS of /proc/self/status); 0 where it cannot be read.
double resident_mb();

}  // namespace orcart
