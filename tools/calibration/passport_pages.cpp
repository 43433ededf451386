// The pages of hand-eye calibration, tip and medium.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "tools/calibration/camera_report.hpp"
#include "tools/calibration/hand_eye_command.hpp"
#include "tools/calibration/load_picture.hpp"
#include "tools/calibration/medium.hpp"
#include "tools/calibration/tip.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/report_page.hpp"

namespace orcart {
namespace {

double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

cv::Point whole(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

/// The picture with its corners, and lines to where tracker and hand-eye place them.
cv::Mat placed_corners(const HandEyeView& view, const HandEyeFit& fit) {
  cv::Mat picture, small;
  if (std::filesystem::exists(view.board.image)) picture = load_picture(view.board.image);
  if (picture.empty()) return {16, 16, CV_8UC3, cv::Scalar::all(128)};  // taken away meanwhile
  const int thick = std::max(1, picture.cols / 700);
  const Pose<C, B> X_CB = (view.X_TS * fit.X_SC).inverse() * fit.X_TB;
  for (const BoardCorner& corner : view.board.corners) {
    cv::circle(picture, whole(corner.pixel_px), 4 * thick, {60, 200, 60}, thick, cv::LINE_AA);
    if (const auto there = project(fit.lens, (X_CB * Point<B>{corner.board_mm}).mm))
      cv::line(picture, whole(corner.pixel_px), whole(*there), {40, 40, 255}, thick, cv::LINE_AA);
  }
  const double scale = std::min(1.0, 640.0 / picture.cols);
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  return small;
}

}  // namespace

std::string hand_eye_page(const HandEyeCalibration& c, const std::string& text) {
  Series scatter{.name = "", .colour = "#2a2", .form = SeriesForm::bars, .points = {}};
  Series left_out{.name = "", .colour = "#c22", .form = SeriesForm::bars, .points = {}};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < c.names.size(); ++i) {
    const auto x = static_cast<double>(i);
    scatter.points.emplace_back(x, c.refined.scatters_mm[i]);
    if (i < c.left_out_mm.size()) left_out.points.emplace_back(x, c.left_out_mm[i]);
    names.push_back(std::to_string(i + 1));
  }
  Series across{.name = "", .colour = "#07a", .form = SeriesForm::dots, .points = {}};
  for (const HandEyeView& view : c.views) {
    const Pose<B, B> off = c.refined.X_TB.inverse() * view.X_TS * c.refined.X_SC * view.X_CB;
    across.points.emplace_back(off.translation_mm.x(), off.translation_mm.y());
  }
  std::string body = svg_chart({.title = "Board's origin through each view",
                                .x_label = "view",
                                .y_label = "mm from the mean",
                                .series = {scatter},
                                .names = names});
  if (!left_out.points.empty())
    body += svg_chart({.title = "The same with the view left out",
                       .x_label = "view",
                       .y_label = "mm",
                       .series = {left_out},
                       .names = names,
                       .marks_y = {c.floor_mm}}) +
            "<p>The dashed line is what the tracker's declared noise alone would leave.</p>";
  body += svg_chart({.title = "The origin on the board's plane, through each view",
                     .x_label = "mm",
                     .y_label = "mm",
                     .series = {across},
                     .square = true});
  body +=
      "<h2>Each picture</h2><p>Green: corners found. Red: to where tracker and hand-eye place them, at true "
      "size.</p>";
  for (std::size_t i = 0; i < c.views.size(); ++i)
    body += "<figure><img src='" + picture_url(placed_corners(c.views[i], c.refined)) + "'><figcaption>" +
            json::format("%zu: ", i + 1) + html_escaped(c.names[i]) +
            json::format(", %.3f mm", c.refined.scatters_mm[i]) + "</figcaption></figure>";
  return html_page({"Hand-eye calibration: " + c.scope.name, text, body});
}

std::string tip_page(const TipCalibration& c, const std::string& text) {
  Series seen{.name = "views", .colour = "#2a2", .form = SeriesForm::dots, .points = {}};
  Series line{.name = "known + window", .colour = "#07a", .form = SeriesForm::line, .points = {}};
  Series errors{.name = "", .colour = "#c22", .form = SeriesForm::bars, .points = {}};
  std::vector<std::string> names;
  double farthest = 0;
  for (std::size_t i = 0; i < c.views.size(); ++i) {
    seen.points.emplace_back(c.views[i].known_mm, c.views[i].camera_mm);
    errors.points.emplace_back(static_cast<double>(i), c.fit.errors_mm[i]);
    names.push_back(json::format("%g mm", c.views[i].known_mm));
    farthest = std::max(farthest, c.views[i].known_mm);
  }
  for (const double at : {0.0, farthest}) line.points.emplace_back(at, at + c.fit.window_mm);
  const std::string body = svg_chart({.title = "From the optical centre against from the window",
                                      .x_label = "known, mm",
                                      .y_label = "seen, mm",
                                      .series = {line, seen}}) +
                           svg_chart({.title = "Error of each distance, its view left out",
                                      .x_label = "known distance",
                                      .y_label = "mm",
                                      .series = {errors},
                                      .names = names});
  return html_page({"Distal window: " + c.scope.name, text, body});
}

std::string medium_page(const ScopeModel& air, const MediumConversion& fluid, const std::string& text) {
  Series in_air{.name = "air", .colour = "#07a", .form = SeriesForm::line, .points = {}};
  Series in_fluid{.name = "fluid", .colour = "#c22", .form = SeriesForm::line, .points = {}};
  constexpr std::array<double, 4> kDepths_mm{5, 10, 20, 60};
  constexpr std::array<const char*, 4> kColours{"#c22", "#a60", "#2a2", "#07a"};
  Chart left{.title = "What one viewpoint leaves at each depth",
             .x_label = "px from the circle's middle",
             .y_label = "px",
             .series = {}};
  for (std::size_t d = 0; d < kDepths_mm.size(); ++d)
    left.series.push_back({.name = json::format("%g mm", kDepths_mm[d]),
                           .colour = kColours[d],
                           .form = SeriesForm::line,
                           .points = {}});
  const Eigen::Vector3d back(0, 0, fluid.viewpoint_mm);
  constexpr int kSteps = 60;
  for (int i = 0; i <= kSteps; ++i) {
    const double radius = air.mask.radius_px * i / kSteps;
    const Eigen::Vector2d pixel(air.mask.cx_px + radius, air.mask.cy_px);
    if (pixel.x() > air.width_px - 1) break;
    const auto a = direction_of(air.lens, pixel), f = direction_of(fluid.scope.lens, pixel);
    if (a) in_air.points.emplace_back(radius, degrees(std::acos(std::min(1.0, a->z()))));
    if (f) in_fluid.points.emplace_back(radius, degrees(std::acos(std::min(1.0, f->z()))));
    for (std::size_t d = 0; d < kDepths_mm.size(); ++d) {
      const auto seen = seen_in_fluid(air, pixel, refractive_index(fluid.scope.medium), kDepths_mm[d]);
      const auto again = seen ? project(fluid.scope.lens, *seen + back) : std::nullopt;
      if (again) left.series[d].points.emplace_back(radius, (*again - pixel).norm());
    }
  }
  const std::string body = svg_chart({.title = "The view in air and in fluid",
                                      .x_label = "px from the circle's middle",
                                      .y_label = "degrees off axis",
                                      .series = {in_air, in_fluid}}) +
                           svg_chart(left);
  return html_page({"Passport from air to fluid: " + air.name, text, body});
}

}  // namespace orcart
