// Rows beside the paper's, and what is no number.
#include "tools/evaluate/paper_rows.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace orcart {
namespace {

const Statistics kOurs{.count = 7,
                       .mean = 0.14,
                       .sd = 0.06,
                       .p95 = 0.25,
                       .max = std::numeric_limits<double>::quiet_NaN(),
                       .mean_low = 0.11,
                       .mean_high = 0.19};

TEST(PaperRows, TellWhatIsNoNumberAsADash) {
  EXPECT_EQ(
      paper_row_text("tracking", kOurs, &kPaperRows[0]),
      "tracking        0.140  0.060  0.250      -       7   0.110 to 0.190               0.2   0.1  0.3  "
      "(same pose, 5 trials)\n");
  EXPECT_NE(paper_row_html("tracking", kOurs, nullptr).find("<td>-</td><td>7</td>"), std::string::npos);
  EXPECT_NE(json_of(kOurs).find("\"max_mm\": null, \"n\": 7"), std::string::npos);
}

}  // namespace
}  // namespace orcart
