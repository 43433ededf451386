// Plots drawn by hand: they need no script, no font but the reader's own, and print well.
#include "firmware-host/report/svg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace orcart {
namespace {

constexpr int kWidth = 420, kHeight = 120, kLeft = 8, kBottom = 22, kTop = 14;

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

std::string open_svg() {
  return text("<svg viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" role=\"img\">", kWidth, kHeight, kWidth,
              kHeight);
}

double x_of_ms(double ms) {
  const double span = std::log10(1000.0 / 1e-3);
  return kLeft + (kWidth - 2.0 * kLeft) * std::clamp(std::log10(std::max(ms, 1e-3) / 1e-3) / span, 0.0, 1.0);
}

std::string marker(double ms, const char* colour, const char* label) {
  const double x = x_of_ms(ms);
  return text("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"%s\" stroke-width=\"1.5\"/>", x, x,
              kTop - 2, kHeight - kBottom, colour) +
         text("<text x=\"%.1f\" y=\"%d\" font-size=\"9\" fill=\"%s\" text-anchor=\"middle\">%s</text>", x,
              kTop - 4, colour, label);
}

std::string time_axis() {
  std::string out;
  const char* labels[] = {"1 &#181;s", "10", "100", "1 ms", "10", "100", "1 s"};
  for (int i = 0; i < 7; ++i) {
    const double x = x_of_ms(1e-3 * std::pow(10.0, i));
    out += text("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" class=\"tick\"/>", x, x, kTop,
                kHeight - kBottom);
    out += text("<text x=\"%.1f\" y=\"%d\" font-size=\"9\" class=\"label\" text-anchor=\"%s\">%s</text>", x,
                kHeight - 8, i == 0 ? "start" : (i == 6 ? "end" : "middle"), labels[i]);
  }
  return out;
}

/// Bars scale with the logarithm of the count, so that one late sample can be seen beside a hundred thousand.
double bar_height(std::uint64_t count, std::uint64_t largest) {
  if (count == 0) return 0;
  return (kHeight - kBottom - kTop) * (std::log10(static_cast<double>(count)) + 0.35) /
         (std::log10(static_cast<double>(largest)) + 0.35);
}

}  // namespace

std::string svg_histogram(const Distribution& d) {
  std::string out = open_svg() + time_axis();
  const std::uint64_t largest = d.bins.empty() ? 0 : *std::max_element(d.bins.begin(), d.bins.end());
  for (std::size_t i = 0; i < d.bins.size(); ++i) {
    if (d.bins[i] == 0) continue;
    const double x = x_of_ms(bin_lower_ms(static_cast<int>(i))),
                 next = x_of_ms(bin_lower_ms(static_cast<int>(i) + 1));
    const double h = bar_height(d.bins[i], largest);
    const char* kind = d.bound_ms > 0 && bin_lower_ms(static_cast<int>(i)) > d.bound_ms ? "bar over" : "bar";
    out += text(
        "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"%s\"><title>%llu</title></rect>",
        x, kHeight - kBottom - h, std::max(next - x - 0.4, 0.8), h, kind,
        static_cast<unsigned long long>(d.bins[i]));
  }
  if (d.budget_ms > 0) out += marker(d.budget_ms, "#b07a00", "budget");
  if (d.bound_ms > 0 && x_of_ms(d.bound_ms) - x_of_ms(d.budget_ms) > 32)
    out += marker(d.bound_ms, "#b03030", "bound");
  return out + "</svg>";
}

std::string svg_coverage(const std::vector<CoveragePoint>& points, double duration_s) {
  if (points.empty() || duration_s <= 0) return "";
  double most = 0.05;
  for (const auto& p : points) most = std::max(most, p.covered);
  const auto x = [&](double s) { return kLeft + 30 + (kWidth - 2 * kLeft - 30) * s / duration_s; };
  const auto y = [&](double c) { return kHeight - kBottom - (kHeight - kBottom - kTop) * c / most; };
  std::string line;
  double last = points.front().covered;
  for (const auto& p : points) {
    line += text("%.1f,%.1f %.1f,%.1f ", x(p.at_s), y(last), x(p.at_s), y(p.covered));
    last = p.covered;
  }
  std::string out = open_svg();
  out += text("<text x=\"%d\" y=\"%.1f\" font-size=\"9\" class=\"label\">%.0f %%</text>", kLeft, y(most) + 3,
              most * 100);
  out += text("<text x=\"%d\" y=\"%.1f\" font-size=\"9\" class=\"label\">0</text>", kLeft, y(0));
  out += text("<text x=\"%d\" y=\"%d\" font-size=\"9\" class=\"label\" text-anchor=\"end\">%.0f s</text>",
              kWidth - kLeft, kHeight - 8, duration_s);
  return out + "<polyline fill=\"none\" class=\"curve\" points=\"" + line + "\"/></svg>";
}

std::string svg_error(const PaintingError& error) {
  std::string out = open_svg();
  const std::uint64_t largest =
      error.bins.empty() ? 0 : *std::max_element(error.bins.begin(), error.bins.end());
  const double step =
      (kWidth - 2.0 * kLeft) / static_cast<double>(std::max<std::size_t>(error.bins.size(), 1));
  for (std::size_t i = 0; i < error.bins.size(); ++i) {
    const double h = bar_height(error.bins[i], largest);
    out += text("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"bar\"/>",
                kLeft + step * static_cast<double>(i), kHeight - kBottom - h, std::max(step - 0.5, 0.5), h);
    if (i % 10 == 0) {
      out += text("<text x=\"%.1f\" y=\"%d\" font-size=\"9\" class=\"label\">%.1f%s</text>",
                  kLeft + step * static_cast<double>(i), kHeight - 8, kErrorBinMm * static_cast<double>(i),
                  i == 0 ? " mm" : "");
    }
  }
  return out + "</svg>";
}

}  // namespace orcart
