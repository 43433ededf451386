// The evaluation in its three forms.
#include "tools/evaluate/evaluation_report.hpp"

#include <algorithm>
#include <cstdio>

#include "firmware-host/files/whole_file.hpp"
#include "tools/evaluate/paper_rows.hpp"
#include "tools/evaluate/stated_errors.hpp"

namespace orcart {

namespace {

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[640];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

std::string quoted(const std::string& s) {
  std::string out = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

const Statistics& row_of(const SimulationResult& result, int row) {
  return row == 0 ? result.tracking : row == 1 ? result.tip : result.mapping;
}

/// A scope that does not turn has no part of its light post.
std::vector<std::size_t> parts_of(const NoiseRun& run) {
  std::vector<std::size_t> parts;
  for (std::size_t c = 0; c < kComponents; ++c)
    if (static_cast<Component>(c) != Component::light_post || run.model.light_post_rad > 0)
      parts.push_back(c);
  return parts;
}

std::string table_text(const NoiseRun& run) {
  std::string out =
      text("\n%s: %.2f mm RMS a marker, %d set-ups of chance (%.1f s)\n", run.name.c_str(),
           run.model.marker_rms_mm, static_cast<int>(run.result.tracking.count / 5), run.result.seconds);
  out += paper_header_text();
  for (int row = 0; row < 3; ++row) {
    const PaperRow& paper = kPaperRows[static_cast<std::size_t>(row)];
    out += paper_row_text(paper.name, row_of(run.result, row), &paper);
  }
  out += paper_row_text("tip in 3-D", run.result.tip_3d, nullptr);
  out += "budget of the mapping error, each part alone\n";
  for (const std::size_t c : parts_of(run)) {
    const Statistics& s = run.result.alone[c];
    out += text("  %-13s %5.3f  %5.3f  %5.3f  %5.2f%s\n", kComponentNames[c], s.mean, s.sd, s.p95, s.max,
                c + 1 == kComponents ? "   (the floor: picture and texel)" : "");
  }
  out += text(
      "predicted RMS     %.3f mean; its 95 %% ellipse holds %.1f %% of %zu (%.1f %% with the %zu that "
      "land on another fold; %zu lost)\n",
      run.result.predicted_rms.mean, 100 * run.result.coverage.share(), run.result.coverage.points,
      100 * run.result.coverage_all.share(), run.result.jumped, run.result.lost);
  return out;
}

std::string json_of(const ErrorModel& m) {
  return text(
             "{\"marker_rms_mm\": %g, \"fiducial_rms_mm\": %g, \"fiducials\": %d, \"hand_eye_mm\": %g, "
             "\"hand_eye_rad\": %g, \"lens_centre_px\": %g, \"lens_focal\": %g, \"lens_edge_px\": %g, ",
             m.marker_rms_mm, m.fiducial_rms_mm, m.fiducials, m.hand_eye_mm, m.hand_eye_rad, m.lens_centre_px,
             m.lens_focal, m.lens_edge_px) +
         text(
             "\"refraction\": %g, \"time_s\": %g, \"speed_mm_s\": %g, \"turn_rad_s\": %g, "
             "\"light_post_rad\": %g, \"picture_px\": %g, \"texel_mm\": %g}",
             m.refraction, m.time_s, m.speed_mm_s, m.turn_rad_s, m.light_post_rad, m.picture_px, m.texel_mm);
}

std::string json_of(const NoiseRun& run) {
  const SimulationResult& r = run.result;
  std::string out = "  {\"name\": " + quoted(run.name) + ", \"model\": " + json_of(run.model) +
                    ",\n   \"tracking\": " + json_of(r.tracking) + ",\n   \"tip\": " + json_of(r.tip) +
                    ",\n   \"tip_3d\": " + json_of(r.tip_3d) + ",\n   \"mapping\": " + json_of(r.mapping) +
                    ",\n   \"budget\": {";
  for (std::size_t c = 0; c < kComponents; ++c)
    out += (c == 0 ? "" : ",\n    ") + quoted(kComponentNames[c]) + ": " + json_of(r.alone[c]);
  out += "},\n   \"predicted_rms\": " + json_of(r.predicted_rms);
  return out + text(
                   ",\n   \"coverage95\": %.4f, \"coverage95_points\": %zu, \"coverage95_with_folds\": %.4f, "
                   "\"landed_on_another_fold\": %zu, \"lost\": %zu, \"seconds\": %.2f}",
                   r.coverage.share(), r.coverage.points, r.coverage_all.share(), r.jumped, r.lost,
                   r.seconds);
}

std::string pair_text(const PairReport& pair) {
  std::string out = pair.first + " and " + pair.second + ": ";
  if (pair.found.patches.empty())
    return out + text("no patch with texture enough in both (%zu looked at)", pair.found.looked_at);
  out += text("%.2f mm apart (median of %zu patches, p95 %.2f), predicted %.2f", pair.found.median_mm,
              pair.found.patches.size(), pair.found.p95_mm, pair.predicted_mm);
  if (pair.true_mm >= 0) out += text(", truly %.2f", pair.true_mm);
  return out + (pair.alarm() ? "  ALARM: over twice the predicted; check reference, passport and time" : "");
}

constexpr const char* kBlind =
    "Correlation cannot see a shift that both pictures share, such as an error of the registration.";

/// A bar a component, and all together.
std::string budget_svg(const NoiseRun& run) {
  constexpr double kWidth = 640, kRow = 24, kLeft = 110;
  double most = run.result.mapping.p95;
  for (const Statistics& s : run.result.alone) most = std::max(most, s.p95);
  const std::vector<std::size_t> parts = parts_of(run);
  const double height = kRow * static_cast<double>(parts.size() + 1);
  std::string out = text("<svg viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" font-size=\"12\">",
                         kWidth, height, kWidth, height);
  for (std::size_t row = 0; row <= parts.size(); ++row) {
    const bool alone = row < parts.size();
    const Statistics& s = alone ? run.result.alone[parts[row]] : run.result.mapping;
    const double y = kRow * static_cast<double>(row), scale = (kWidth - kLeft - 150) / most;
    out += text(
               "<text x=\"0\" y=\"%.0f\">%s</text><rect x=\"%.0f\" y=\"%.0f\" width=\"%.1f\" height=\"16\" "
               "fill=\"#9cc5d3\"/><rect x=\"%.0f\" y=\"%.0f\" width=\"%.1f\" height=\"16\" fill=\"%s\"/>",
               y + 15, alone ? kComponentNames[parts[row]] : "all together", kLeft, y + 3, s.p95 * scale,
               kLeft, y + 3, s.mean * scale, alone ? "#1f6f8b" : "#b0562b") +
           text("<text x=\"%.1f\" y=\"%.0f\">%.2f mean, %.2f p95</text>", kLeft + s.p95 * scale + 6, y + 15,
                s.mean, s.p95);
  }
  return out + "</svg>\n";
}

std::string histogram_svg(const NoiseRun& run) {
  constexpr int kBins = 60;
  constexpr double kBinMm = 0.05, kWidth = 640, kHeight = 150, kBase = 128;
  std::vector<double> bins(kBins, 0);
  for (const double e : run.result.mapping_errors_mm)
    bins[static_cast<std::size_t>(std::min<double>(kBins - 1, e / kBinMm))] += 1;
  const double most = std::max(1.0, *std::max_element(bins.begin(), bins.end()));
  std::string out = text("<svg viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" font-size=\"11\">",
                         kWidth, kHeight, kWidth, kHeight);
  for (int i = 0; i < kBins; ++i)
    out += text("<rect x=\"%.1f\" y=\"%.1f\" width=\"9\" height=\"%.1f\" fill=\"#1f6f8b\"/>", 10.0 * i + 10,
                kBase - 120 * bins[static_cast<std::size_t>(i)] / most,
                120 * bins[static_cast<std::size_t>(i)] / most);
  for (int mm = 0; mm <= 2; ++mm)
    out += text("<text x=\"%.0f\" y=\"146\">%d mm</text>", 10 + mm / kBinMm * 10, mm);
  return out +
         text("<text x=\"%.0f\" y=\"146\" text-anchor=\"end\">3 mm and more</text></svg>\n", kWidth - 24);
}

std::string table_html(const NoiseRun& run) {
  std::string out = "<table>" + paper_header_html();
  for (int row = 0; row < 3; ++row) {
    const PaperRow& paper = kPaperRows[static_cast<std::size_t>(row)];
    out += paper_row_html(paper.name, row_of(run.result, row), &paper);
  }
  return out + paper_row_html("tip in 3-D", run.result.tip_3d, nullptr) + "</table>\n";
}

std::string run_html(const NoiseRun& run) {
  const SimulationResult& r = run.result;
  const ErrorModel& m = run.model;
  return text("<h2>%s: %.2f mm RMS a marker</h2>\n", run.name.c_str(), m.marker_rms_mm) + table_html(run) +
         "<h3>Where the mapping error comes from: each part alone, and all together</h3>\n" +
         budget_svg(run) + "<h3>Mapping errors</h3>\n" + histogram_svg(run) +
         text(
             "<p>Predicted by propagation: %.3f mm RMS on average; its 95 %% ellipse holds %.1f %% of %zu "
             "errors on the same sheet of surface, %.1f %% of all (%zu landed on another fold, %zu "
             "missed).</p>\n",
             r.predicted_rms.mean, 100 * r.coverage.share(), r.coverage.points, 100 * r.coverage_all.share(),
             r.jumped, r.lost) +
         "<p>Drawn: " + sources_text(m) +
         text(" at %.0f mm/s; picture %.2f px; texel %.2f mm (assumed).</p>\n", m.speed_mm_s, m.picture_px,
              m.texel_mm);
}

constexpr const char* kStyle =
    "<style>body{font:15px/1.5 system-ui,sans-serif;max-width:1020px;margin:2em auto;padding:0 1em;"
    "color:#1c1f24}table{border-collapse:collapse;font-size:14px}td,th{padding:.2em .9em .2em "
    "0;text-align:left}"
    "figure{display:inline-block;margin:0 12px 12px 0}figcaption{font-size:13px;color:#555;max-width:480px}"
    "</style>";

}  // namespace

std::string text_of(const EvaluationReport& report) {
  std::string out = "surface  " + report.surface + " (" + report.surface_hash + "), seen from " +
                    report.seen_from + "\nscope    " + report.scope + "\nerrors   " +
                    sources_text(report.model) + "\n";
  for (const NoiseRun& run : report.runs) out += table_text(run);
  if (!report.pairs.empty()) out += "\nconsistency of overlapping captures, without landmarks\n";
  for (const PairReport& pair : report.pairs) out += "  " + pair_text(pair) + "\n";
  if (!report.pairs.empty()) out += std::string("  ") + kBlind + "\n";
  for (const std::string& note : report.notes) out += "note     " + note + "\n";
  return out + "Rigid errors only: tissue that has shifted is not in these figures.\n";
}

std::string json_of(const EvaluationReport& report) {
  std::string out =
      "{\"surface\": " + quoted(report.surface) + ", \"errors_from\": " + sources_json(report.model) +
      ", \"surface_hash\": " + quoted(report.surface_hash) + ", \"scope\": " + quoted(report.scope) +
      text(", \"setups\": %d, \"seed\": %llu,\n \"runs\": [\n", report.setups,
           static_cast<unsigned long long>(report.seed));
  for (std::size_t i = 0; i < report.runs.size(); ++i) out += (i == 0 ? "" : ",\n") + json_of(report.runs[i]);
  out += "],\n \"pairs\": [";
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const PairReport& pair = report.pairs[i];
    out +=
        std::string(i == 0 ? "" : ",\n  ") + "{\"first\": " + quoted(pair.first) +
        ", \"second\": " + quoted(pair.second) +
        text(
            ", \"patches\": %zu, \"median_mm\": %.4f, \"p95_mm\": %.4f, \"predicted_mm\": %.4f, \"true_mm\": "
            "%.4f, \"alarm\": %s}",
            pair.found.patches.size(), pair.found.median_mm, pair.found.p95_mm, pair.predicted_mm,
            pair.true_mm, pair.alarm() ? "true" : "false");
  }
  return out + text("],\n \"seconds\": %.2f}\n", report.seconds);
}

Result<void> write_page(const std::filesystem::path& dir, const EvaluationReport& report) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error) return fail(dir.string() + ": cannot be made: " + error.message());
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>orcart evaluate</title>" +
      std::string(kStyle) + "<h1>How accurate the painting is</h1>\n<p>" + report.surface + ", seen from " +
      report.seen_from + "; " + report.scope +
      text(
          ". %d independent set-ups, seed %llu, %.1f s. Research use only; not a medical device. "
          "Rigid errors only: tissue that has shifted is not in these figures.</p>\n",
          report.setups, static_cast<unsigned long long>(report.seed), report.seconds);
  for (const NoiseRun& run : report.runs) page += run_html(run);
  if (!report.pairs.empty()) page += "<h2>Consistency of overlapping captures, without landmarks</h2>\n<ul>";
  for (const PairReport& pair : report.pairs) page += "<li>" + pair_text(pair) + "</li>\n";
  if (!report.pairs.empty()) page += std::string("</ul><p>") + kBlind + "</p>\n";
  for (const CaptionedPicture& picture : report.pictures) {
    const auto written = write_png(dir / picture.name, picture.picture.width_px, picture.picture.height_px,
                                   picture.picture.rgba);
    if (!written) return written;
    page += "<figure><img src=\"" + picture.name + "\" alt=\"\"><figcaption>" + picture.caption +
            "</figcaption></figure>\n";
  }
  if (auto written = write_whole_file(dir / "evaluation.json", json_of(report)); !written) return written;
  return write_whole_file(dir / "evaluation.html", page + "</html>\n");
}

}  // namespace orcart
