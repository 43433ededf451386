// The answer of `orcart calibrate time`, in four forms.
#include <algorithm>
#include <cmath>

#include "tools/calibration/time_command.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/report_page.hpp"

namespace orcart {
namespace {

constexpr double kMs = 1e3;

const char* word_for(MotionFrom from) {
  return from == MotionFrom::board ? "board" : "features";
}

double misfit_in_unit(const TimeCalibration& c, double misfit) {
  return c.from == MotionFrom::board ? misfit : 1e3 * misfit;
}

const char* unit_of(const TimeCalibration& c) {
  return c.from == MotionFrom::board ? "mm" : "mrad";
}

}  // namespace

std::string sync_snippet(const TimeCalibration& c) {
  return json::format(
      "[sync]\n# tracker against video, calibrated on %s from %zu movements: +- %.1f ms (95 %%)\n"
      "tracker_against_video_ms = %.1f\ntracker_against_video_deviation_ms = %.2f\n",
      iso_date(0).c_str(), c.fit.movements.size(), kMs * c.fit.half_width_s, kMs * c.tracker_against_video_s,
      kMs * c.fit.deviation_s());
}

std::string time_text(const TimeCalibration& c) {
  std::string out = json::format(
      "tracker against video: %.2f ms +- %.2f ms (95 %%), from %zu movements by the %s of %zu of %zu "
      "pictures\n",
      kMs * c.tracker_against_video_s, kMs * c.fit.half_width_s, c.fit.movements.size(),
      c.from == MotionFrom::board ? "board" : "features", c.used, c.frames);
  if (c.recorded_with_s != 0)
    out += json::format("  the recording was made with %.2f ms; found besides: %.2f ms\n",
                        kMs * c.recorded_with_s, kMs * c.fit.lag_s);
  out += json::format("  the marker's motion explains %.2f %% of the pictures'\n", 100 * c.fit.explained);
  for (std::size_t i = 0; i < c.fit.movements.size(); ++i) {
    const MovementLag& m = c.fit.movements[i];
    out += json::format("  movement %2zu  %7.2f to %7.2f s  %4zu samples  by itself %7.2f ms  %.3f %s RMS\n",
                        i + 1, m.from_s, m.to_s, m.samples, kMs * (c.recorded_with_s + m.lag_s),
                        misfit_in_unit(c, m.misfit), unit_of(c));
  }
  for (const std::string& note : c.notes) out += "  note: " + note + "\n";
  return out + "for cart.toml:\n" + sync_snippet(c);
}

std::string time_json(const TimeCalibration& c) {
  std::vector<std::string> movements, notes;
  for (const MovementLag& m : c.fit.movements)
    movements.push_back("{\"from_s\": " + json::number(m.from_s) + ", \"to_s\": " + json::number(m.to_s) +
                        ", \"samples\": " + std::to_string(m.samples) +
                        ", \"lag_ms\": " + json::number(kMs * m.lag_s) +
                        ", \"misfit\": " + json::number(misfit_in_unit(c, m.misfit)) + "}");
  for (const std::string& note : c.notes) notes.push_back(json::text(note));
  return "{\"tracker_against_video_ms\": " + json::number(kMs * c.tracker_against_video_s) +
         ", \"half_width_95_ms\": " + json::number(kMs * c.fit.half_width_s) +
         ", \"deviation_ms\": " + json::number(kMs * c.fit.deviation_s()) +
         ", \"recorded_with_ms\": " + json::number(kMs * c.recorded_with_s) +
         ", \"motion_from\": " + json::text(word_for(c.from)) +
         ", \"explained\": " + json::number(c.fit.explained) + ", \"frames\": " + std::to_string(c.frames) +
         ", \"used\": " + std::to_string(c.used) + ", \"misfit_unit\": " + json::text(unit_of(c)) +
         ",\n \"movements\": " + json::list(movements) + ",\n \"notes\": " + json::list(notes) + "}\n";
}

std::string time_page(const TimeCalibration& c) {
  Series misfit{.name = "", .colour = "#c22", .form = SeriesForm::line, .points = {}};
  for (std::size_t i = 0; i < c.fit.lags_s.size(); ++i)
    misfit.points.emplace_back(kMs * (c.recorded_with_s + c.fit.lags_s[i]),
                               misfit_in_unit(c, c.fit.misfits[i]));
  Series each{.name = "", .colour = "#2a2", .form = SeriesForm::dots, .points = {}};
  for (std::size_t i = 0; i < c.fit.movements.size(); ++i)
    each.points.emplace_back(static_cast<double>(i + 1),
                             kMs * (c.recorded_with_s + c.fit.movements[i].lag_s));
  const double lag = kMs * c.tracker_against_video_s, half = kMs * c.fit.half_width_s;
  std::string body = svg_chart({.title = "Misfit against lag",
                                .x_label = "tracker_against_video, ms",
                                .y_label = std::string(unit_of(c)) + " RMS",
                                .series = {misfit},
                                .marks_x = {lag}});
  body += svg_chart({.title = "Each movement by itself, and the 95 % interval of all",
                     .x_label = "movement",
                     .y_label = "ms",
                     .series = {each},
                     .marks_y = {lag - half, lag, lag + half}});
  body += "<h2>Pace of the scope, the tracker's shifted by the lag</h2><p>Blue: tracker. Red: pictures" +
          std::string(c.from == MotionFrom::board ? "." : ", made as large.") + "</p>";
  constexpr double kPart_s = 8;
  if (c.tracker_pace.empty()) return html_page({"Tracker against video", time_text(c), body});
  const double first = c.tracker_pace.front().x(), last = c.tracker_pace.back().x();
  const int parts = std::min(6, static_cast<int>(std::ceil((last - first) / kPart_s)));
  for (int i = 0; i < parts; ++i) {
    const double from = first + kPart_s * i;
    Chart part{.title = "", .x_label = "s", .y_label = "mm/s", .series = {}};
    for (const auto& [paces, colour] :
         {std::pair{&c.tracker_pace, "#07a"}, std::pair{&c.picture_pace, "#c22"}}) {
      Series one{.name = "", .colour = colour, .form = SeriesForm::dots, .points = {}};
      for (const Eigen::Vector2d& p : *paces)
        if (p.x() >= from && p.x() < from + kPart_s) one.points.push_back(p);
      part.series.push_back(std::move(one));
    }
    if (!part.series[1].points.empty()) body += svg_chart(part);
  }
  return html_page({"Tracker against video", time_text(c), body});
}

}  // namespace orcart
