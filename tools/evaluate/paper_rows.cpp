// One form of a row for simulated and recorded data.
#include "tools/evaluate/paper_rows.hpp"

#include <cmath>

#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

using json::format;

std::string padded(double value, const char* pattern, std::size_t width) {
  std::string out = std::isnan(value) ? "-" : format(pattern, value);
  return std::string(out.size() < width ? width - out.size() : 0, ' ') + out;
}

std::string cell(double value, const char* pattern) {
  return "<td>" + padded(value, pattern, 0) + "</td>";
}

std::string fixed(double value) {
  return std::isnan(value) ? "null" : format("%.4f", value);
}

}  // namespace

std::string paper_header_text() {
  return "error, mm        mean   s.d.    p95    max       n   mean's 95 %        the paper: mean  s.d.  "
         "max\n";
}

std::string paper_row_text(const std::string& name, const Statistics& s, const PaperRow* paper) {
  std::string out = format("%-15s ", name.c_str()) + padded(s.mean, "%.3f", 5) + "  " +
                    padded(s.sd, "%.3f", 5) + "  " + padded(s.p95, "%.3f", 5) + "  " +
                    padded(s.max, "%.2f", 5) +
                    format("  %6zu   %.3f to %.3f", s.count, s.mean_low, s.mean_high);
  if (paper != nullptr)
    out +=
        format("               %.1f   %.1f  %.1f  (%s)", paper->mean, paper->sd, paper->max, paper->protocol);
  return out + "\n";
}

std::string paper_header_html() {
  return "<tr><th>error, mm</th><th>mean</th><th>s.d.</th><th>p95</th><th>max</th><th>n</th>"
         "<th>95 % of the mean</th><th>the paper: mean, s.d., max</th></tr>\n";
}

std::string paper_row_html(const std::string& name, const Statistics& s, const PaperRow* paper) {
  std::string out = "<tr><td>" + name + "</td>" + cell(s.mean, "%.3f") + cell(s.sd, "%.3f") +
                    cell(s.p95, "%.3f") + cell(s.max, "%.2f") +
                    format("<td>%zu</td><td>%.3f to %.3f</td><td>", s.count, s.mean_low, s.mean_high);
  if (paper != nullptr)
    out += format("%.1f, %.1f, %.1f (%s)", paper->mean, paper->sd, paper->max, paper->protocol);
  return out + "</td></tr>\n";
}

std::string json_of(const Statistics& s) {
  return "{\"mean_mm\": " + fixed(s.mean) + ", \"sd_mm\": " + fixed(s.sd) + ", \"p95_mm\": " + fixed(s.p95) +
         ", \"max_mm\": " + fixed(s.max) +
         format(", \"n\": %zu, \"mean_ci95_mm\": [%.4f, %.4f]}", s.count, s.mean_low, s.mean_high);
}

}  // namespace orcart
