// The recorded errors as text, as JSON and as a page.
#include "firmware-host/files/whole_file.hpp"
#include "tools/evaluate/paper_rows.hpp"
#include "tools/evaluate/recorded/board_mapping.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

using json::format;

std::string row_of(const Statistics& s) {
  return format("%6.3f  %6.3f  %6.3f", s.mean, s.sd, s.max);
}

std::string cells_of(const Statistics& s) {
  return format("<td>%.3f</td><td>%.3f</td><td>%.3f</td>", s.mean, s.sd, s.max);
}

/// The paper's three rows with ours beside them; `row` makes one of them.
template <class Row>
std::string rows_of(const BoardMappingReport& r, const Row& row) {
  std::string out;
  if (r.tracking.from != TrackingFrom::nothing) out += row("tracking", r.tracking.error, &kPaperRows[0]);
  return out + row("tip", r.tip, &kPaperRows[1]) + row("tip in 3-D", r.tip_3d, nullptr) +
         row("mapping", r.all, &kPaperRows[2]);
}

const char* word_of(TrackingFrom from) {
  if (from == TrackingFrom::rests) return "rests";
  return from == TrackingFrom::implied ? "implied" : "nothing";
}

std::string tracking_sentence(const BoardMappingReport& r) {
  const TrackingError& t = r.tracking;
  if (t.from == TrackingFrom::nothing)
    return "tracking: not known: no view shows the scope at rest, and the views are too few to tell their "
           "noise; --still names recordings of tools at rest";
  if (t.from == TrackingFrom::implied)
    return format(
        "tracking: implied, not measured: no view shows the scope at rest. These views' poses and pictures "
        "disagree as if each marker were off by %.2f mm RMS; --still names recordings of tools at rest",
        t.marker_mm);
  return format(
      "tracking: measured, distances from the mean of the same pose read again; stretches at "
      "rest: %zu, drifting and left out: %zu; these recordings' tracker and tool, not the views'; the mean's "
      "confidence is from ten readings each",
      t.still.stretches.size(), t.still.moving);
}

std::vector<std::string> stretches_of(const BoardMappingReport& r) {
  std::vector<std::string> lines;
  lines.reserve(r.tracking.still.stretches.size());
  for (const StillStretch& s : r.tracking.still.stretches)
    lines.push_back(s.file + ", " + s.tool +
                    format(": %zu readings, mean %.3f, RMS %.3f, max %.3f mm", s.readings, s.mean_mm,
                           s.rms_mm, s.max_mm));
  return lines;
}

std::string tip_sentence(const BoardMappingReport& r) {
  return "tip: of " +
         std::string(r.tip_is_window ? "the window" : "the optical centre, since the passport has no X_CE") +
         format(
             ", from each of a view's corners: its distance from where tracker, hand-eye and board (by the "
             "other views) put the tip, less the one from where the picture puts it, which the picture "
             "leaves open by %.2f mm RMS; ",
             r.tip_picture_mm) +
         format(
             "along the optical axis, as orcart calibrate tip counts: mean %.2f, s.d. %.2f, max %.2f mm, n "
             "%zu",
             r.tip_along.mean, r.tip_along.sd, r.tip_along.max, r.tip_along.count);
}

/// What a mapping error of this size comes from, in sentences.
std::vector<std::string> limits_of(const BoardMappingReport& r) {
  return {
      format("the same corners through each view's own best pose (no tracker, no hand-eye): %.3f mm RMS; "
             "painting and finding again add %.3f mm on average",
             r.lens_rms_mm, r.painting.mean),
      "what is left is the views' poses: the tracker's, the hand-eye pose and the board's place, all from "
      "the other views",
      format("the tracker's declared noise alone would throw the board's origin by %.2f mm RMS",
             r.tracker_floor_mm),
      format("one point a view, the board's origin in 3-D, as orcart calibrate handeye counts: mean "
             "%.2f, s.d. %.2f, max %.2f mm, n %zu",
             r.origin.mean, r.origin.sd, r.origin.max, r.origin.count)};
}

std::string light_text(const LightStep& step) {
  return format("%-15s mean %5.1f of 255 grey levels (%4.1f %%), p95 %5.1f, %zu places; %zu more are white",
                step.name.c_str(), step.grey.mean, step.percent, step.grey.p95, step.grey.count,
                step.clipped);
}

constexpr const char* kProtocol =
    "Each view is painted onto the board's plane by hand-eye and board as the other views alone know them; "
    "error is the distance of a corner found in the painting from where it is printed. Corners of one view "
    "share its pose, so the views are what counts.";

constexpr const char* kStyle =
    "<style>body{font:15px/1.5 system-ui,sans-serif;max-width:1020px;margin:2em auto;padding:0 1em;"
    "color:#1c1f24}table{border-collapse:collapse;font-size:14px}td,th{padding:.2em .9em .2em "
    "0;text-align:left}figure{display:inline-block;margin:0 12px 12px 0}figcaption{font-size:13px;color:#555;"
    "max-width:480px}img{max-width:480px}</style>";

std::string table_html(const BoardMappingReport& r) {
  std::string out =
      "<table><tr><th>view</th><th>found of seen</th><th>mean, mm</th><th>s.d.</th><th>max</th>"
      "<th>own best pose, RMS</th><th>painting adds</th><th>origin in 3-D</th><th>tip in 3-D</th></tr>\n";
  for (const ViewMapping& v : r.views)
    out += "<tr><td>" + v.image + format("</td><td>%zu of %zu</td>", v.corners.size(), v.seen) +
           cells_of(v.error) +
           format("<td>%.3f</td><td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n", v.lens_rms_mm,
                  v.painting.mean, v.origin_mm, v.tip.apart_mm);
  out += format("<tr><th>all</th><th>%zu</th>", r.all.count) + cells_of(r.all) +
         format("<td>%.3f</td><td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n", r.lens_rms_mm, r.painting.mean,
                r.origin.mean, r.tip_3d.mean);
  return out + "</table>\n";
}

}  // namespace

std::string text_of(const BoardMappingReport& r) {
  std::string out = "the paper's errors on recorded views of " + r.pattern + ", " + r.mode + " mode\n" +
                    paper_header_text() + rows_of(r, paper_row_text) + tracking_sentence(r) + "\n";
  for (const std::string& stretch : stretches_of(r)) out += "  " + stretch + "\n";
  out += tip_sentence(r) + "\nmapping: " + kProtocol + "\n" +
         "view                      found     mean    s.d.     max   (mm)  own pose  painting  origin  tip "
         "3-D\n";
  for (const ViewMapping& v : r.views)
    out += format("%-22s %4zu/%-4zu ", v.image.c_str(), v.corners.size(), v.seen) + row_of(v.error) +
           format("           %5.3f     %5.3f   %5.2f    %5.2f\n", v.lens_rms_mm, v.painting.mean,
                  v.origin_mm, v.tip.apart_mm);
  out += format("%-22s %4zu      ", "all", r.all.count) + row_of(r.all) +
         format("           %5.3f     %5.3f   %5.2f    %5.2f\n", r.lens_rms_mm, r.painting.mean,
                r.origin.mean, r.tip_3d.mean);
  for (const std::string& limit : limits_of(r)) out += "limit    " + limit + "\n";
  out += "step of grey across the joins of all views\n";
  for (const LightStep& step : r.light) out += "  " + light_text(step) + "\n";
  for (const std::string& note : r.notes) out += "note     " + note + "\n";
  return out;
}

std::string json_of(const BoardMappingReport& r) {
  std::vector<std::string> views, light, stretches, notes;
  for (const ViewMapping& v : r.views)
    views.push_back("{\"image\": " + json::text(v.image) +
                    format(", \"seen\": %zu, \"found\": %zu, \"error\": ", v.seen, v.corners.size()) +
                    json_of(v.error) + ", \"painting\": " + json_of(v.painting) +
                    format(", \"own_pose_rms_mm\": %.4f, \"origin_mm\": %.4f, \"tip_3d_mm\": %.4f, "
                           "\"tip_along_mm\": %.4f}",
                           v.lens_rms_mm, v.origin_mm, v.tip.apart_mm, v.tip.along_mm));
  for (const LightStep& s : r.light)
    light.push_back(
        "{\"light\": " + json::text(s.name) +
        format(
            ", \"mean_grey\": %.2f, \"p95_grey\": %.2f, \"percent\": %.2f, \"places\": %zu, \"white\": %zu}",
            s.grey.mean, s.grey.p95, s.percent, s.grey.count, s.clipped));
  for (const StillStretch& stretch : r.tracking.still.stretches)
    stretches.push_back("{\"file\": " + json::text(stretch.file) + ", \"tool\": " + json::text(stretch.tool) +
                        format(", \"readings\": %zu, \"mean_mm\": %.4f, \"rms_mm\": %.4f, \"max_mm\": %.4f}",
                               stretch.readings, stretch.mean_mm, stretch.rms_mm, stretch.max_mm));
  for (const std::string& note : r.notes) notes.push_back(json::text(note));
  const bool tracked = r.tracking.from != TrackingFrom::nothing;
  return "{\"pattern\": " + json::text(r.pattern) + ", \"mode\": " + json::text(r.mode) +
         ",\n \"tracking\": " + (tracked ? json_of(r.tracking.error) : "null") +
         ", \"tracking_from\": " + json::text(word_of(r.tracking.from)) +
         ",\n \"at_rest\": " + json::list(stretches) + ",\n \"tip\": " + json_of(r.tip) +
         ",\n \"tip_3d\": " + json_of(r.tip_3d) + ",\n \"tip_along\": " + json_of(r.tip_along) +
         format(",\n \"tip_picture_mm\": %.4f", r.tip_picture_mm) + ",\n \"mapping\": " + json_of(r.all) +
         ",\n \"painting\": " + json_of(r.painting) + ",\n \"origin\": " + json_of(r.origin) +
         format(",\n \"own_pose_rms_mm\": %.4f, \"tracker_floor_mm\": %.4f,\n \"views\": ", r.lens_rms_mm,
                r.tracker_floor_mm) +
         json::list(views) + ",\n \"light\": " + json::list(light) + ",\n \"notes\": " + json::list(notes) +
         format(", \"seconds\": %.2f}\n", r.seconds);
}

Result<void> write_page(const std::filesystem::path& dir, const BoardMappingReport& r) {
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>The paper's errors on recorded "
      "views</title>" +
      std::string(kStyle) + "<h1>The paper's errors on recorded views</h1>\n<p>" + r.pattern + ", " + r.mode +
      " mode. Research use only; not a medical device.</p>\n<table>" + paper_header_html() +
      rows_of(r, paper_row_html) + "</table>\n<p>" + tracking_sentence(r) + ".</p>\n<ul>";
  for (const std::string& stretch : stretches_of(r)) page += "<li>" + stretch + "</li>\n";
  page += "</ul>\n<p>" + tip_sentence(r) + ".</p>\n<h2>Mapping, view by view</h2>\n<p>" + kProtocol +
          "</p>\n" + table_html(r) + "<ul>";
  for (const std::string& limit : limits_of(r)) page += "<li>" + limit + "</li>\n";
  page +=
      "</ul><h2>Joins between the views</h2>\n<p>Bright paper of the one and the other view, over the same "
      "places beside each join.</p><ul>";
  for (const LightStep& step : r.light) page += "<li>" + light_text(step) + "</li>\n";
  page += "</ul>";
  page +=
      "<h2>Paintings</h2>\n<p>Green rings: where corners are printed; red: from there to where they are "
      "found. view-1, view-2, ... and board.ply beside this page hold what <code>orcart paint</code> "
      "needs to paint each again.</p>\n";
  std::error_code trouble;
  std::filesystem::create_directories(dir, trouble);
  if (trouble) return fail(dir.string() + ": cannot be made: " + trouble.message());
  for (const CaptionedPicture& picture : r.pictures) {
    if (auto written = write_png(dir / picture.name, picture.picture.width_px, picture.picture.height_px,
                                 picture.picture.rgba);
        !written)
      return written;
    page += "<figure><img src=\"" + picture.name + "\" alt=\"\"><figcaption>" + picture.caption +
            "</figcaption></figure>\n";
  }
  page += "<h2>Notes</h2>\n<ul>";
  for (const std::string& note : r.notes) page += "<li>" + note + "</li>\n";
  page += "</ul>\n";
  if (auto written = write_whole_file(dir / "mapping.json", json_of(r)); !written) return written;
  return write_whole_file(dir / "mapping.html", page + "</html>\n");
}

}  // namespace orcart
