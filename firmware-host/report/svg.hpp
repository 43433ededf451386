// Small plots as inline SVG: a histogram with its budget, a curve, a bar chart.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/report/run_report.hpp"

namespace orcart {

/// Counts on a logarithmic time axis, the budget and the bound drawn in.
std::string svg_histogram(const Distribution& distribution);
/// Coverage in percent over the seconds of the run.
std::string svg_coverage(const std::vector<CoveragePoint>& points, double duration_s);
/// Distribution of painting errors; 0.02 mm bins.
std::string svg_error(const PaintingError& error);

}  // namespace orcart
