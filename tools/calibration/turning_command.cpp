// Pictures and poses in, [turning] out; and the answer in its three forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "tools/calibration/hand_eye_command.hpp"
#include "tools/calibration/turning.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/poses_file.hpp"
#include "tools/registration/report_page.hpp"

namespace orcart {
namespace {

double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

/// Poses that are not there, and poses that nothing would be made of.
Result<void> check_marker(const TurningCommand& command) {
  if (!command.second_poses.empty() && command.poses.empty())
    return fail(
        "a second marker's poses stand alone; the scope's own marker's are needed beside them (--poses)");
  if (command.marker == TurnMarker::head && command.poses.empty())
    return fail("a marker on the head (--marker head) is told by its poses; --poses is wanted too");
  if (command.marker == TurnMarker::shaft && !command.poses.empty() && command.second_poses.empty())
    return fail(
        "the poses of a marker on the shaft (--marker shaft) tell no turn; leave --poses out, or give a "
        "second marker's on the head (--second-poses)");
  return {};
}

}  // namespace

Result<TurningCalibration> calibrate_turning(const TurningCommand& command, const ScopeModel& scope,
                                             const Progress& progress) {
  std::vector<Pose<T, S>> X_TS, second;
  TurningCalibration result{.scope = scope};
  if (auto told = check_marker(command); !told) return tl::unexpected(told.error());
  for (const auto& [file, poses] :
       {std::pair{&command.poses, &X_TS}, std::pair{&command.second_poses, &second}}) {
    if (file->empty()) continue;
    const auto read = read_poses(*file);
    if (!read) return tl::unexpected(read.error());
    result.notes.insert(result.notes.end(), read->notes.begin(), read->notes.end());
    auto paired = poses_of_pictures(command.images, *read, *file);
    if (!paired) return tl::unexpected(paired.error());
    *poses = std::move(*paired);
  }
  const auto seen = see_boards(command.images, command.pattern, progress);
  if (!seen) return tl::unexpected(seen.error());
  const double aspect = scope.lens.fy_px / scope.lens.fx_px;
  for (std::size_t i = 0; i < seen->views.size(); ++i) {
    const BoardView& view = seen->views[i];
    const std::string name = view.image.filename().string();
    if (auto sized = check_size(view, scope); !sized) return tl::unexpected(sized.error());
    if (view.corners.empty() || view.anchor != Anchor::sure) {
      result.notes.push_back(name + " is not used: " +
                             (view.corners.empty()
                                  ? view.remark
                                  : "which corner is which cannot be told once it is turned; "
                                    "ChArUco, coloured dots or an odd by even board can"));
      continue;
    }
    cv::Mat grey;
    cv::cvtColor(seen->pictures[i], grey, cv::COLOR_BGR2GRAY);
    TurnSight sight{.name = name, .corners = view.corners, .notch_rad = find_mask(grey, aspect).notch_rad};
    if (!X_TS.empty()) sight.X_TS = X_TS[i];
    if (!second.empty())
      sight.X_TL = Pose<T, L>{.rotation = second[i].rotation, .translation_mm = second[i].translation_mm};
    result.sights.push_back(std::move(sight));
  }
  auto fit = fit_turning(
      result.sights, {.aspect = aspect,
                      .view_angle_rad = command.view_angle_rad,
                      .marker = command.marker.value_or(X_TS.empty() ? TurnMarker::shaft : TurnMarker::head),
                      .view_S = scope.X_SC.rotation.col(2),
                      .passport_notch_rad = scope.notch_rad});
  if (!fit) return tl::unexpected(fit.error());
  result.fit = std::move(*fit);
  result.notes.insert(result.notes.end(), result.fit.notes.begin(), result.fit.notes.end());
  result.scope.turning = result.fit.turning;
  if (!result.scope.notch_rad) result.scope.notch_rad = result.fit.notch_zero_rad;
  return result;
}

std::string turning_text(const TurningCalibration& c) {
  const Turning& t = c.fit.turning;
  std::string out = json::format(
      "the picture turns about %.2f %.2f px (+- %.2f), corners %.3f px RMS, %zu pictures over %.0f degrees\n",
      t.centre_px.x(), t.centre_px.y(), t.centre_deviation_px, c.fit.rms_px, c.sights.size(),
      degrees(c.fit.range_rad));
  if (t.marker == TurnMarker::head)
    out += json::format(
        "  marker on the head: axis %.4f %.4f %.4f through %.3f %.3f %.3f mm in it, %.3f mm RMS; its turns "
        "differ from the picture's by %.3f degrees RMS\n  the view lies %.2f degrees off the shaft (stated: "
        "%.0f)\n",
        t.axis.x(), t.axis.y(), t.axis.z(), t.axis_point_mm.x(), t.axis_point_mm.y(), t.axis_point_mm.z(),
        c.fit.axis_rms_mm, degrees(c.fit.angle_rms_rad),
        degrees(std::acos(std::clamp(t.axis.dot(c.scope.X_SC.rotation.col(2)), -1.0, 1.0))),
        degrees(t.view_angle_rad));
  else
    out += "  marker on the shaft: it does not turn with the camera head\n";
  if (c.fit.notch_zero_rad)
    out += json::format("  notch at %.2f degrees at turn 0; it tells a turn to %.3f degrees RMS\n",
                        degrees(*c.fit.notch_zero_rad), degrees(c.fit.notch_rms_rad));
  if (t.notch_deviation_rad)
    out += json::format("  a turn by the notch is known to %.3f degrees (so many pictures allowed for)\n",
                        degrees(*t.notch_deviation_rad));
  if (t.R_SL)
    out += json::format("second marker: its turns agree with the pictures' to %.3f degrees RMS\n",
                        degrees(c.fit.second_rms_rad));
  for (std::size_t i = 0; i < c.sights.size(); ++i)
    out += json::format("  %-32s turn %8.3f degrees  %4zu corners  %.3f px%s\n", c.sights[i].name.c_str(),
                        degrees(c.fit.turns_rad[i]), c.sights[i].corners.size(), c.fit.each_px[i],
                        c.sights[i].notch_rad ? "  notch" : "");
  for (const std::string& note : c.notes) out += "  note: " + note + "\n";
  return out;
}

std::string turning_json(const TurningCalibration& c) {
  const Turning& t = c.fit.turning;
  std::vector<std::string> pictures, notes;
  for (std::size_t i = 0; i < c.sights.size(); ++i)
    pictures.push_back("{\"image\": " + json::text(c.sights[i].name) + ", \"turn_rad\": " +
                       json::number(c.fit.turns_rad[i]) + ", \"rms_px\": " + json::number(c.fit.each_px[i]) +
                       ", \"notch_rad\": " + json::number(c.sights[i].notch_rad.value_or(NAN)) + "}");
  for (const std::string& note : c.notes) notes.push_back(json::text(note));
  return "{\"centre_px\": " + json::numbers(t.centre_px) +
         ", \"centre_deviation_px\": " + json::number(t.centre_deviation_px) +
         ", \"rms_px\": " + json::number(c.fit.rms_px) + ", \"range_rad\": " + json::number(c.fit.range_rad) +
         ",\n \"marker\": " + (t.marker == TurnMarker::head ? "\"head\"" : "\"shaft\"") +
         ", \"axis\": " + json::numbers(t.axis) + ", \"axis_point_mm\": " + json::numbers(t.axis_point_mm) +
         ", \"axis_rms_mm\": " + json::number(c.fit.axis_rms_mm) +
         ", \"angle_rms_rad\": " + json::number(c.fit.angle_rms_rad) +
         ", \"second_rms_rad\": " + json::number(t.R_SL ? c.fit.second_rms_rad : NAN) +
         ",\n \"notch_zero_rad\": " + json::number(c.fit.notch_zero_rad.value_or(NAN)) +
         ", \"notch_rms_rad\": " + json::number(c.fit.notch_rms_rad) +
         ", \"notch_deviation_rad\": " + json::number(t.notch_deviation_rad.value_or(NAN)) +
         ",\n \"pictures\": " + json::list(pictures) + ",\n \"notes\": " + json::list(notes) + "}\n";
}

std::string turning_page(const TurningCalibration& c) {
  constexpr std::array<const char*, 6> kColours{"#c22", "#2a2", "#07a", "#a60", "#80a", "#555"};
  Chart round{.title = "Corners going round the centre",
              .x_label = "px",
              .y_label = "height less y, px",
              .series = {},
              .square = true};
  for (std::size_t i = 0; i < c.sights.size(); ++i) {
    Series one{.name = "", .colour = kColours[i % kColours.size()], .form = SeriesForm::dots, .points = {}};
    for (const BoardCorner& corner : c.sights[i].corners)
      one.points.emplace_back(corner.pixel_px.x(), c.scope.height_px - corner.pixel_px.y());
    round.series.push_back(std::move(one));
  }
  round.marks_x = {c.fit.turning.centre_px.x()};
  round.marks_y = {c.scope.height_px - c.fit.turning.centre_px.y()};
  Series residuals{.name = "", .colour = "#c22", .form = SeriesForm::bars, .points = {}};
  Series notch{.name = "", .colour = "#07a", .form = SeriesForm::dots, .points = {}};
  Chart bars{.title = "Residual of each picture", .x_label = "picture", .y_label = "px RMS", .series = {}};
  for (std::size_t i = 0; i < c.sights.size(); ++i) {
    residuals.points.emplace_back(static_cast<double>(i), c.fit.each_px[i]);
    bars.names.push_back(std::to_string(i + 1));
    if (c.sights[i].notch_rad && c.fit.notch_zero_rad)
      notch.points.emplace_back(
          degrees(c.fit.turns_rad[i]),
          degrees(std::remainder(*c.sights[i].notch_rad - c.fit.turns_rad[i] - *c.fit.notch_zero_rad,
                                 2 * std::numbers::pi)));
  }
  bars.series = {residuals};
  std::string body = svg_chart(round) + svg_chart(bars);
  if (!notch.points.empty())
    body += svg_chart({.title = "Notch less turn",
                       .x_label = "turn, degrees",
                       .y_label = "degrees",
                       .series = {notch},
                       .marks_y = {0}});
  return html_page({"Turning scope: " + c.scope.name, turning_text(c), body});
}

}  // namespace orcart
