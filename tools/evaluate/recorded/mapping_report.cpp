// The recorded mapping error as text, as JSON and as a page.
#include "firmware-host/files/whole_file.hpp"
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

std::string object_of(const Statistics& s) {
  return format("{\"mean_mm\": %.4f, \"sd_mm\": %.4f, \"p95_mm\": %.4f, \"max_mm\": %.4f, \"n\": %zu}",
                s.mean, s.sd, s.p95, s.max, s.count);
}

/// What an error of this size comes from, in sentences.
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
      "<th>own best pose, RMS</th><th>painting adds</th><th>origin in 3-D</th></tr>\n";
  for (const ViewMapping& v : r.views)
    out +=
        "<tr><td>" + v.image + format("</td><td>%zu of %zu</td>", v.corners.size(), v.seen) +
        cells_of(v.error) +
        format("<td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n", v.lens_rms_mm, v.painting.mean, v.origin_mm);
  out +=
      format("<tr><th>all</th><th>%zu</th>", r.all.count) + cells_of(r.all) +
      format("<td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n", r.lens_rms_mm, r.painting.mean, r.origin.mean);
  return out +
         "<tr><td>the paper, 4 landmarks</td><td></td><td>1.2</td><td>0.6</td><td>1.8</td></tr></table>\n";
}

}  // namespace

std::string text_of(const BoardMappingReport& r) {
  std::string out =
      "mapping error on recorded views of " + r.pattern + ", " + r.mode + " mode\n" + kProtocol + "\n" +
      "view                      found     mean    s.d.     max   (mm)  own pose  painting  origin\n";
  for (const ViewMapping& v : r.views)
    out += format("%-22s %4zu/%-4zu ", v.image.c_str(), v.corners.size(), v.seen) + row_of(v.error) +
           format("           %5.3f     %5.3f   %5.2f\n", v.lens_rms_mm, v.painting.mean, v.origin_mm);
  out += format("%-22s %4zu      ", "all", r.all.count) + row_of(r.all) +
         format("           %5.3f     %5.3f   %5.2f\n", r.lens_rms_mm, r.painting.mean, r.origin.mean);
  out += format("%-22s %4d       1.2     0.6     1.8\n", "the paper", 4);
  out +=
      format("95 %% of the mean: %.2f to %.2f mm, from the views' means\n", r.all.mean_low, r.all.mean_high);
  for (const std::string& limit : limits_of(r)) out += "limit    " + limit + "\n";
  out += "step of grey across the joins of all views\n";
  for (const LightStep& step : r.light) out += "  " + light_text(step) + "\n";
  for (const std::string& note : r.notes) out += "note     " + note + "\n";
  return out;
}

std::string json_of(const BoardMappingReport& r) {
  std::vector<std::string> views, light, notes;
  for (const ViewMapping& v : r.views)
    views.push_back("{\"image\": " + json::text(v.image) +
                    format(", \"seen\": %zu, \"found\": %zu, \"error\": ", v.seen, v.corners.size()) +
                    object_of(v.error) + ", \"painting\": " + object_of(v.painting) +
                    format(", \"own_pose_rms_mm\": %.4f, \"origin_mm\": %.4f}", v.lens_rms_mm, v.origin_mm));
  for (const LightStep& s : r.light)
    light.push_back(
        "{\"light\": " + json::text(s.name) +
        format(
            ", \"mean_grey\": %.2f, \"p95_grey\": %.2f, \"percent\": %.2f, \"places\": %zu, \"white\": %zu}",
            s.grey.mean, s.grey.p95, s.percent, s.grey.count, s.clipped));
  for (const std::string& note : r.notes) notes.push_back(json::text(note));
  return "{\"pattern\": " + json::text(r.pattern) + ", \"mode\": " + json::text(r.mode) +
         ",\n \"mapping\": " + object_of(r.all) + ",\n \"painting\": " + object_of(r.painting) +
         ",\n \"origin\": " + object_of(r.origin) +
         format(",\n \"own_pose_rms_mm\": %.4f, \"tracker_floor_mm\": %.4f,\n \"views\": ", r.lens_rms_mm,
                r.tracker_floor_mm) +
         json::list(views) + ",\n \"light\": " + json::list(light) + ",\n \"notes\": " + json::list(notes) +
         format(", \"seconds\": %.2f}\n", r.seconds);
}

Result<void> write_page(const std::filesystem::path& dir, const BoardMappingReport& r) {
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Mapping error on recorded "
      "views</title>" +
      std::string(kStyle) + "<h1>Mapping error on recorded views</h1>\n<p>" + r.pattern + ", " + r.mode +
      " mode. " + kProtocol + " Research use only; not a medical device.</p>\n" + table_html(r) + "<ul>";
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
