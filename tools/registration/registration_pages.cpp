// The pages of `orcart pivot` and `orcart register`.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/registration/json_text.hpp"
#include "tools/registration/pivot.hpp"
#include "tools/registration/register_points.hpp"
#include "tools/registration/report_page.hpp"

namespace orcart {

std::string pivot_page(const std::vector<NamedPose>& poses, const PivotFit& fit, const std::string& text) {
  Series kept{.name = "agreeing", .colour = "#2a2", .form = SeriesForm::dots, .points = {}};
  Series left_out{.name = "left out", .colour = "#c22", .form = SeriesForm::dots, .points = {}};
  Series ways{.name = "", .colour = "#07a", .form = SeriesForm::dots, .points = {}};
  Series across{.name = "", .colour = "#07a", .form = SeriesForm::dots, .points = {}};
  const Eigen::Vector3d shaft = fit.robust.tip_mm.normalized();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const NamedPose& pose : poses) middle += pose.X_TS.rotation * shaft;
  const Eigen::Vector3d e1 = middle.unitOrthogonal(), e2 = middle.normalized().cross(e1);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose<T, S>& X = poses[i].X_TS;
    const Eigen::Vector3d off = X.rotation * fit.robust.tip_mm + X.translation_mm - fit.robust.pivot_mm;
    (off.norm() <= fit.inlier_mm ? kept : left_out)
        .points.emplace_back(static_cast<double>(i + 1), off.norm());
    const Eigen::Vector3d way = X.rotation * shaft;
    ways.points.emplace_back(way.dot(e1) * 180 / std::numbers::pi, way.dot(e2) * 180 / std::numbers::pi);
    if (off.norm() <= fit.inlier_mm) across.points.emplace_back(off.dot(e1), off.dot(e2));
  }
  const std::string body = svg_chart({.title = "Tip's distance from the pivot",
                                      .x_label = "pose",
                                      .y_label = "mm",
                                      .series = {kept, left_out},
                                      .marks_y = {fit.inlier_mm}}) +
                           svg_chart({.title = "Where the tool pointed, about its middle",
                                      .x_label = "degrees",
                                      .y_label = "degrees",
                                      .series = {ways},
                                      .square = true}) +
                           svg_chart({.title = "The tip about the pivot, across the middle way",
                                      .x_label = "mm",
                                      .y_label = "mm",
                                      .series = {across},
                                      .square = true});
  return html_page({"Pivot calibration", text, body});
}

std::string register_page(const Registration& registration, const std::string& text,
                          const std::string& more) {
  Series errors{.name = "", .colour = "#c22", .form = SeriesForm::bars, .points = {}};
  Chart bars{.title = "Error of each fiducial", .x_label = "", .y_label = "mm", .series = {}};
  Series from_front{.name = "fixed", .colour = "#2a2", .form = SeriesForm::dots, .points = {}};
  Series moved{
      .name = "moving, its error 20 times as long", .colour = "#c22", .form = SeriesForm::dots, .points = {}};
  double farthest = 10;
  for (std::size_t i = 0; i < registration.points.size(); ++i) {
    const RegisteredPoint& p = registration.points[i];
    errors.points.emplace_back(static_cast<double>(i), p.error_mm);
    bars.names.push_back(p.fixed);
    const Eigen::Vector3d there = (registration.X_MR * Point<R>{p.moving_mm}).mm;
    from_front.points.emplace_back(p.fixed_mm.x(), p.fixed_mm.z());
    const Eigen::Vector3d drawn = p.fixed_mm + 20 * (there - p.fixed_mm);
    moved.points.emplace_back(drawn.x(), drawn.z());
    farthest = std::max(farthest, 1.5 * (p.fixed_mm - registration.centroid_mm).norm());
  }
  bars.series = {errors};
  Chart away{.title = "Expected error away from the fiducials' middle",
             .x_label = "mm along each of their axes",
             .y_label = "mm RMS",
             .series = {}};
  const char* colours[] = {"#07a", "#2a2", "#c22"};
  for (int axis = 0; axis < 3; ++axis) {
    Series one{
        .name = json::format("axis %d, spread %.1f mm", axis + 1, std::sqrt(registration.spread2_mm2[axis])),
        .colour = colours[axis],
        .form = SeriesForm::line,
        .points = {}};
    for (int i = 0; i <= 40; ++i) {
      const double at = farthest * i / 40;
      one.points.emplace_back(
          at, predicted_tre_mm(registration, registration.centroid_mm + at * registration.axes.col(axis)));
    }
    away.series.push_back(std::move(one));
  }
  const std::string body = svg_chart(bars) + svg_chart(away) +
                           svg_chart({.title = "Fiducials from the front (x left, z up)",
                                      .x_label = "mm",
                                      .y_label = "mm",
                                      .series = {from_front, moved},
                                      .square = true});
  return html_page({"Registration", text, body + more});
}

}  // namespace orcart
