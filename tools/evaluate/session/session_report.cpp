// A session's consistency as text, as JSON and as a page with a chart over time.
#include <algorithm>

#include "firmware-host/files/whole_file.hpp"
#include "tools/evaluate/session/session_consistency.hpp"
#include "tools/evaluate/stated_errors.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {

namespace {

using json::format;

constexpr const char* kBlind =
    "Correlation cannot see a shift that both pictures share: an error of the registration, or a reference "
    "that slipped before the first of them.";

std::string head_of(const SessionReport& r) {
  return format(
      "%zu captures (%zu more were undone); %zu pairs match, of which %zu lie apart by more than twice "
      "the predicted; %zu see one place but do not match; %zu see nothing together",
      r.captures, r.undone, r.pairs.size(), r.alarms(), r.unmatched, r.without_overlap);
}

std::string break_text(const SessionReport& r) {
  if (const auto gap = r.break_in_time())
    return format(
        "between %s (%.1f s) and %s (%.1f s) something moved: all %zu pairs that reach across lie "
        "apart; touch a landmark, look at the reference",
        gap->after.c_str(), gap->from_s, gap->before.c_str(), gap->to_s, gap->pairs);
  if (r.unmatched > r.pairs.size())
    return "most pairs that see one place do not match: light, passport or registration may be wrong";
  return r.alarms() > 0 ? "no one instant explains the alarms" : "no alarm";
}

std::string velocities_text(const SessionReport& r) {
  const VelocitySources& v = r.velocities;
  return format(
             "velocity: of %zu captures by the cart's tracker samples, of %zu by the captures beside them in "
             "a "
             "stream, of %zu assumed",
             v.stored, v.neighbours, v.assumed) +
         (v.stored + v.neighbours > 0 ? format("; those known move by %.1f mm/s and %.3f rad/s in the mean",
                                               v.speed_mm_s, v.turn_rad_s)
                                      : "");
}

/// Dots over the second capture's time; the hollow ones are twice the predicted. Alarms are red.
std::string chart(const SessionReport& r) {
  constexpr double kWidth = 700, kHeight = 220, kLeft = 50, kBase = 190, kTop = 10;
  double most_mm = 0.5, last_s = 1;
  for (const SessionPair& p : r.pairs) {
    most_mm = std::max({most_mm, p.pair.found.median_mm, 2 * p.pair.predicted_mm});
    last_s = std::max(last_s, p.second_s);
  }
  const auto x = [&](double s) { return kLeft + (kWidth - kLeft - 10) * s / last_s; };
  const auto y = [&](double mm) { return kBase - (kBase - kTop) * mm / most_mm; };
  std::string out = format(
      "<svg viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" font-size=\"12\">"
      "<line x1=\"%.0f\" y1=\"%.0f\" x2=\"%.0f\" y2=\"%.0f\" stroke=\"#999\"/>",
      kWidth, kHeight, kWidth, kHeight, kLeft, kBase, kWidth, kBase);
  for (int i = 0; i <= 4; ++i)
    out += format("<text x=\"0\" y=\"%.0f\">%.2f mm</text>", y(most_mm * i / 4) + 4, most_mm * i / 4) +
           format("<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"%s\">%.0f s</text>", x(last_s * i / 4),
                  kBase + 18, i == 4 ? "end" : "middle", last_s * i / 4);
  for (const SessionPair& p : r.pairs)
    out += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"none\" stroke=\"#888\"/>", x(p.second_s),
                  y(2 * p.pair.predicted_mm)) +
           format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>", x(p.second_s),
                  y(p.pair.found.median_mm), p.pair.alarm() ? "#c0392b" : "#1f6f8b");
  return out + "</svg>\n";
}

constexpr const char* kStyle =
    "<style>body{font:15px/1.5 system-ui,sans-serif;max-width:1020px;margin:2em auto;padding:0 1em;"
    "color:#1c1f24}table{border-collapse:collapse;font-size:14px}td,th{padding:.2em .9em .2em "
    "0;text-align:left}.alarm{color:#c0392b}</style>";

}  // namespace

std::string text_of(const SessionReport& r) {
  std::string out = "consistency of " + r.session + " on " + r.surface + "\n" + head_of(r) + "\n" +
                    "errors: " + sources_text(r.model) + "\n" + velocities_text(r) + "\n" +
                    "   time, s  pair                          apart, mm    p95  patches  predicted\n";
  for (const SessionPair& p : r.pairs)
    out += format("%10.1f  %-14s%-14s  %9.2f  %5.2f  %7zu  %9.2f%s\n", p.second_s, p.pair.first.c_str(),
                  p.pair.second.c_str(), p.pair.found.median_mm, p.pair.found.p95_mm,
                  p.pair.found.patches.size(), p.pair.predicted_mm, p.pair.alarm() ? "  ALARM" : "");
  out += break_text(r) + "\n";
  for (const std::string& note : r.notes) out += "note: " + note + "\n";
  return out + kBlind + "\n";
}

std::string json_of(const SessionReport& r) {
  std::vector<std::string> pairs, gaps;
  for (const SessionPair& p : r.pairs)
    pairs.push_back("{\"first\": " + json::text(p.pair.first) + ", \"second\": " + json::text(p.pair.second) +
                    format(", \"first_s\": %.3f, \"second_s\": %.3f, \"patches\": %zu, \"median_mm\": %.4f, "
                           "\"p95_mm\": %.4f, \"predicted_mm\": %.4f, \"alarm\": %s}",
                           p.first_s, p.second_s, p.pair.found.patches.size(), p.pair.found.median_mm,
                           p.pair.found.p95_mm, p.pair.predicted_mm, p.pair.alarm() ? "true" : "false"));
  for (const SessionGap& g : r.gaps)
    gaps.push_back(format("{\"from_s\": %.3f, \"to_s\": %.3f, \"pairs\": %zu, \"alarms\": %zu}", g.from_s,
                          g.to_s, g.pairs, g.alarms));
  return "{\"session\": " + json::text(r.session) + ", \"errors_from\": " + sources_json(r.model) +
         ", \"surface\": " + json::text(r.surface) +
         format(
             ", \"captures\": %zu, \"undone\": %zu, \"without_overlap\": %zu, \"unmatched\": %zu, "
             "\"alarms\": %zu, "
             "\"break\": %s,\n ",
             r.captures, r.undone, r.without_overlap, r.unmatched, r.alarms(),
             r.break_in_time() ? "true" : "false") +
         format(
             "\"velocity\": {\"stored\": %zu, \"neighbours\": %zu, \"assumed\": %zu, \"mean_mm_s\": %.3f, "
             "\"mean_rad_s\": %.4f},\n \"pairs\": ",
             r.velocities.stored, r.velocities.neighbours, r.velocities.assumed, r.velocities.speed_mm_s,
             r.velocities.turn_rad_s) +
         json::list(pairs) + ",\n \"gaps\": " + json::list(gaps) +
         format(", \"seconds\": %.2f}\n", r.seconds);
}

Result<void> write_page(const std::filesystem::path& dir, const SessionReport& r) {
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Consistency of a "
      "session</title>" +
      std::string(kStyle) + "<h1>Do the captures fit together?</h1>\n<p>" + r.session + " on " + r.surface +
      ": " + head_of(r) + ". Research use only; not a medical device.</p>\n<p><b>" + break_text(r) +
      ".</b></p>\n" + chart(r) +
      "<p>Full: how far two captures lie apart on the surface, at the time of the later one; "
      "hollow: twice the predicted; red: beyond it.</p>\n<table><tr><th>time, "
      "s</th><th>captures</th><th>apart, mm</th><th>p95</th><th>patches</th><th>predicted</th>"
      "</tr>\n";
  for (const SessionPair& p : r.pairs)
    page += format(
        "<tr%s><td>%.1f</td><td>%s, %s</td><td>%.2f</td><td>%.2f</td><td>%zu</td><td>%.2f</td></tr>\n",
        p.pair.alarm() ? " class=\"alarm\"" : "", p.second_s, p.pair.first.c_str(), p.pair.second.c_str(),
        p.pair.found.median_mm, p.pair.found.p95_mm, p.pair.found.patches.size(), p.pair.predicted_mm);
  page += "</table>\n";
  page += "<p>Predicted from: " + sources_text(r.model) + "; " + velocities_text(r) + ".</p>\n";
  for (const std::string& note : r.notes) page += "<p>" + note + "</p>\n";
  std::error_code trouble;
  std::filesystem::create_directories(dir, trouble);
  if (trouble) return fail(dir.string() + ": cannot be made: " + trouble.message());
  if (auto written = write_whole_file(dir / "consistency.json", json_of(r)); !written) return written;
  return write_whole_file(dir / "consistency.html", page + "<p>" + kBlind + "</p></html>\n");
}

}  // namespace orcart
