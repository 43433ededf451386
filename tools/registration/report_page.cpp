// Charts drawn by hand: no script, no other file, and they print well.
#include "tools/registration/report_page.hpp"

#include <algorithm>
#include <cmath>

#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr double kWidth = 470, kHeight = 300, kLeft = 56, kRight = 12, kTop = 28, kBottom = 44;

struct Range {
  double low = 0, high = 1;
  void take(double value) { low = std::min(low, value), high = std::max(high, value); }
  double span() const { return high - low; }
};

struct Frame {
  Range x, y;
  double left(double value) const { return kLeft + (kWidth - kLeft - kRight) * (value - x.low) / x.span(); }
  double top(double value) const {
    return kHeight - kBottom - (kHeight - kBottom - kTop) * (value - y.low) / y.span();
  }
};

bool finite(const Eigen::Vector2d& p) {
  return std::isfinite(p.x()) && std::isfinite(p.y());
}

/// A little wider than what is in it, and never empty.
void widen(Range& range, bool keep_low) {
  if (!(range.span() > 1e-12)) range.high += 0.5, range.low -= keep_low ? 0 : 0.5;
  const double more = 0.05 * range.span();
  range.high += more;
  if (!keep_low) range.low -= more;
}

Frame frame_of(const Chart& chart) {
  Frame frame{.x = {1e300, -1e300}, .y = {1e300, -1e300}};
  bool bars = false;
  for (const Series& one : chart.series) {
    bars = bars || one.form == SeriesForm::bars;
    for (const Eigen::Vector2d& p : one.points)
      if (finite(p)) frame.x.take(p.x()), frame.y.take(p.y());
  }
  for (const double mark : chart.marks_x) frame.x.take(mark);
  for (const double mark : chart.marks_y) frame.y.take(mark);
  if (frame.x.low > frame.x.high) frame.x = {0, 1};
  if (frame.y.low > frame.y.high) frame.y = {0, 1};
  if (bars) frame.x.take(frame.x.low - 0.6), frame.x.take(frame.x.high + 0.6), frame.y.take(0);
  widen(frame.x, bars);
  widen(frame.y, frame.y.low == 0);
  if (chart.square) {
    const double wide = (kWidth - kLeft - kRight) / frame.x.span(),
                 high = (kHeight - kTop - kBottom) / frame.y.span();
    Range& short_one = wide > high ? frame.x : frame.y;
    const double more = short_one.span() * (std::max(wide, high) / std::min(wide, high) - 1) / 2;
    short_one.low -= more, short_one.high += more;
  }
  return frame;
}

/// 1, 2 or 5 times a power of ten, so that about five fit into the span.
double step_of(double span) {
  const double rough = span / 5, power = std::pow(10, std::floor(std::log10(rough)));
  const double part = rough / power;
  return power * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10);
}

std::vector<double> ticks(const Range& range) {
  const double step = step_of(range.span());
  const auto first = static_cast<int>(std::ceil(range.low / step)),
             last = static_cast<int>(std::floor(range.high / step));
  std::vector<double> values;
  for (int i = first; i <= last; ++i) values.push_back(step * i);
  return values;
}

std::string words(double x, double y, const char* anchor, std::string_view text, const char* more = "") {
  return json::format("<text x='%.1f' y='%.1f' text-anchor='%s' %s>", x, y, anchor, more) +
         html_escaped(text) + "</text>";
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return json::format("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' %s/>", x1, y1, x2, y2, style);
}

std::string axes(const Chart& chart, const Frame& frame) {
  constexpr const char* kGrid = "stroke='#ddd'";
  std::string out;
  const double bottom = kHeight - kBottom;
  for (const double v : ticks(frame.y))
    out += line(kLeft, frame.top(v), kWidth - kRight, frame.top(v), kGrid) +
           words(kLeft - 5, frame.top(v) + 4, "end", json::format("%.4g", v));
  if (chart.names.empty()) {
    for (const double v : ticks(frame.x))
      out += line(frame.left(v), kTop, frame.left(v), bottom, kGrid) +
             words(frame.left(v), bottom + 14, "middle", json::format("%.4g", v));
  }
  const std::size_t every = chart.names.size() / 12 + 1;
  for (std::size_t i = 0; i < chart.names.size(); i += every)
    out += words(frame.left(static_cast<double>(i)), bottom + 14, "middle", chart.names[i]);
  out += words(0.5 * (kLeft + kWidth - kRight), kHeight - 10, "middle", chart.x_label) +
         words(kLeft, kTop - 12, "start", chart.y_label, "class='y'") +
         words(kWidth - kRight, kTop - 12, "end", chart.title, "font-weight='bold'");
  for (const double mark : chart.marks_x)
    out += line(frame.left(mark), kTop, frame.left(mark), bottom, "stroke='#07a' stroke-dasharray='4 3'");
  for (const double mark : chart.marks_y)
    out += line(kLeft, frame.top(mark), kWidth - kRight, frame.top(mark),
                "stroke='#07a' stroke-dasharray='4 3'");
  return out;
}

std::string drawn(const Series& one, const Frame& frame) {
  std::string out, path;
  for (const Eigen::Vector2d& p : one.points) {
    if (!finite(p)) continue;
    const double x = frame.left(p.x()), y = frame.top(p.y());
    switch (one.form) {
      case SeriesForm::dots:
        out += json::format("<circle cx='%.1f' cy='%.1f' r='2.2' fill='%s'/>", x, y, one.colour.c_str());
        break;
      case SeriesForm::line:
        path += json::format("%.1f,%.1f ", x, y);
        break;
      case SeriesForm::bars: {
        const double half = 0.35 * (frame.left(1) - frame.left(0)), zero = frame.top(0);
        out += json::format("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='%s'/>", x - half,
                            std::min(y, zero), 2 * half, std::abs(zero - y), one.colour.c_str());
        break;
      }
    }
  }
  if (!path.empty())
    out += "<polyline fill='none' stroke='" + one.colour + "' stroke-width='1.5' points='" + path + "'/>";
  return out;
}

}  // namespace

std::string picture_data_url(std::string_view kind, std::span<const std::byte> bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out = "data:image/" + std::string(kind) + ";base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (i + k < bytes.size() ? std::to_integer<unsigned>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kLetters[group >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

std::string html_escaped(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    if (letter == '<') {
      out += "&lt;";
    } else if (letter == '&') {
      out += "&amp;";
    } else {
      out += letter;
    }
  }
  return out;
}

std::string svg_chart(const Chart& chart) {
  const Frame frame = frame_of(chart);
  std::string out = json::format(
      "<svg width='%.0f' height='%.0f' viewBox='0 0 %.0f %.0f' role='img'><rect width='100%%' height='100%%' "
      "fill='#fafafa'/>",
      kWidth, kHeight, kWidth, kHeight);
  out += axes(chart, frame);
  double legend = kTop + 14;
  for (const Series& one : chart.series) {
    out += drawn(one, frame);
    if (one.name.empty()) continue;
    out += json::format("<rect x='%.1f' y='%.1f' width='10' height='10' fill='%s'/>", kLeft + 8, legend - 9,
                        one.colour.c_str()) +
           words(kLeft + 22, legend, "start", one.name);
    legend += 15;
  }
  return out + "</svg>\n";
}

std::string html_page(const Page& page) {
  return "<!doctype html><html lang='en'><meta charset='utf-8'><title>" + html_escaped(page.title) +
         "</title><style>body{font:15px sans-serif;margin:24px;max-width:1320px}"
         "pre{background:#f4f4f4;padding:12px;white-space:pre-wrap}svg{margin:6px;font:11px sans-serif}"
         "figure{display:inline-block;margin:6px;vertical-align:top}figcaption{font-size:13px}"
         "img{max-width:420px}</style><h1>" +
         html_escaped(page.title) + "</h1><p>Research use only; not a medical device.</p><pre>" +
         html_escaped(page.text) + "</pre>" + page.body + "\n";
}

}  // namespace orcart
