// The pages of calibration and registration: one self-contained HTML file with charts and pictures.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace orcart {

enum class SeriesForm { dots, line, bars };

/// One set of points of a chart. Bars stand on zero at x = 0, 1, 2, ...
struct Series {
  std::string name;    ///< for the legend; empty: none
  std::string colour;  ///< as CSS says it
  SeriesForm form = SeriesForm::dots;
  std::vector<Eigen::Vector2d> points;
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  bool square = false;               ///< one unit is as long along y as along x
  std::vector<std::string> names{};  ///< below the bars, in their order; else numbers
  std::vector<double> marks_x{};     ///< vertical lines
  std::vector<double> marks_y{};     ///< horizontal lines
};

/// Inline SVG with axes that fit what is drawn. Points that are not finite are left out.
std::string svg_chart(const Chart& chart);

/// Bytes of a picture as a data URL, so that a page needs no other file. `kind`: "jpeg" or "png".
std::string picture_data_url(std::string_view kind, std::span<const std::byte> bytes);

/// "<" and "&" made harmless.
std::string html_escaped(std::string_view text);

struct Page {
  std::string title;
  std::string text;  ///< the answer as the terminal shows it
  std::string body;  ///< HTML
};
std::string html_page(const Page& page);

}  // namespace orcart
