// The paper's Table 1, and rows of ours beside it: as text, as JSON and on a page.
#pragma once

#include <array>
#include <string>

#include "tools/evaluate/statistics.hpp"

namespace orcart {

/// A row of the paper's Table 1 (Dey et al. 2000), mm.
struct PaperRow {
  const char* name;
  double mean, sd, max;
  const char* protocol;
};
inline constexpr std::array<PaperRow, 3> kPaperRows{
    PaperRow{"tracking", 0.2, 0.1, 0.3, "same pose, 5 trials"},
    PaperRow{"tip", 0.8, 0.3, 1.0, "known distances, 5 trials"},
    PaperRow{"mapping", 1.2, 0.6, 1.8, "4 landmarks"}};

/// The line above the rows.
std::string paper_header_text();
/// `paper` may be null. What is no number is told as a dash.
std::string paper_row_text(const std::string& name, const Statistics& ours, const PaperRow* paper);

std::string paper_header_html();
std::string paper_row_html(const std::string& name, const Statistics& ours, const PaperRow* paper);

/// An object; what is no number is null.
std::string json_of(const Statistics& ours);

}  // namespace orcart
