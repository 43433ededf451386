// The report page, its JSON twin, and the ten closing lines.
#include "firmware-host/report/run_report.hpp"

#include <cstdio>
#include <sstream>

#include "firmware-host/files/whole_file.hpp"
#include "firmware-host/report/svg.hpp"

namespace orcart {
namespace {

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

std::string escaped(const std::string& s) {
  std::string out;
  for (const char c : s) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string json_string(const std::string& s) {
  std::string out = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += text("\\u%04x", c);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:980px;margin:2em auto;padding:0 "
    "1em;color:#1c1f24;background:#fbfaf8}"
    "h1{font-size:1.6em;margin-bottom:.2em}h2{font-size:1.15em;margin-top:2em;border-bottom:1px solid #ddd}"
    "table{border-collapse:collapse;width:100%;font-size:14px}td,th{padding:.25em "
    ".6em;text-align:right;border-bottom:1px "
    "solid "
    "#eee}td:first-child,th:first-child{text-align:left}.ok{color:#1d7a3a}.bad{color:#b03030;font-weight:600}"
    ".bar{fill:#4a7fb0}.over{fill:#b03030}.curve{stroke:#1d7a3a;stroke-width:2}.tick{stroke:#e4e0da}.label{"
    "fill:#666}"
    ".grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(430px,1fr));gap:1em}.card{background:#"
    "fff;border:1px "
    "solid #e4e0da;border-radius:6px;padding:.6em .8em}.card "
    "b{display:block}.muted{color:#666;font-size:13px}"
    "img{max-width:100%;border-radius:6px}.banner{background:#fff3d6;border:1px solid #e6c878;padding:.5em "
    "1em;border-radius:6px}"
    ".big{display:flex;flex-wrap:wrap;gap:.8em;margin:1em 0}.big div{background:#fff;border:1px solid "
    "#e4e0da;border-radius:6px;padding:.5em 1em;min-width:7em}.big "
    "b{font-size:1.5em;display:block}svg{width:100%;height:auto}";

std::string tile(const std::string& value, const std::string& label) {
  return "<div><b>" + value + "</b><span class=muted>" + label + "</span></div>";
}

double late_percent(const RunReport& r) {
  return r.frames_shown == 0
             ? 0
             : 100.0 * static_cast<double>(r.frames_late) / static_cast<double>(r.frames_shown);
}

std::string tiles(const RunReport& r) {
  std::string out = "<div class=big>";
  std::uint64_t painted = 0, undone = 0, refused = 0;
  for (const auto& c : r.captures) {
    painted += c.outcome.starts_with("painted");
    undone += c.outcome.starts_with("undone");
    refused += c.outcome.starts_with("refused");
  }
  out += tile(text("%llu", static_cast<unsigned long long>(painted)), "pictures painted");
  out += tile(
      text("%llu / %llu", static_cast<unsigned long long>(undone), static_cast<unsigned long long>(refused)),
      "undone / refused");
  out += tile(text("%.1f %%", 100 * r.coverage), "of the surface covered");
  out += tile(text("%.2f %%", late_percent(r)), "frames late");
  if (!r.errors.empty()) out += tile(text("%.2f mm", r.errors.front().mean_mm), "mean painting error");
  out += tile(text("%.0f MB", r.resident_mb), "resident");
  return out + "</div>";
}

std::string cards(const std::vector<Distribution>& list) {
  std::string out = "<div class=grid>";
  for (const auto& d : list) {
    out += "<div class=card><b>" + escaped(d.name) + "</b><span class=muted>" + escaped(d.note) + "</span>";
    if (d.samples == 0) {
      out += "<p class=muted>no samples</p></div>";
      continue;
    }
    out += svg_histogram(d);
    out += text("<div class=muted>%llu samples; p50 %.3f ms", static_cast<unsigned long long>(d.samples),
                d.p50_ms);
    if (d.judged_quantile > 0.5) out += text(", p%g %.3f ms", 100 * d.judged_quantile, d.judged_ms);
    out += text(", max %.3f ms", d.max_ms);
    if (d.budget_ms > 0) {
      out += text("; budget %.2f ms: <span class=%s>%s</span>; over the bound of %.2f ms: %llu", d.budget_ms,
                  d.within_budget() ? "ok" : "bad", d.within_budget() ? "held" : "missed", d.bound_ms,
                  static_cast<unsigned long long>(d.over_bound));
    }
    out += "</div></div>";
  }
  return out + "</div>";
}

bool is_of_stream(const CaptureRow& c) {
  return c.outcome.ends_with("(stream)");
}

/// A row a capture; the pictures of one stream share a row.
std::string captures_table(const std::vector<CaptureRow>& captures) {
  std::string out =
      "<table><tr><th>unit</th><th>pressed at</th><th>outcome</th><th>acknowledged after</th><th>painted on "
      "panel "
      "after</th><th>pose</th><th>nearest sample</th></tr>";
  const auto ms = [](double v) { return v < 0 ? std::string("&ndash;") : text("%.1f ms", v); };
  for (std::size_t i = 0; i < captures.size(); ++i) {
    const CaptureRow& c = captures[i];
    const std::size_t first = i;
    while (is_of_stream(c) && i + 1 < captures.size() && captures[i + 1].unit == c.unit &&
           captures[i + 1].outcome == c.outcome) {
      ++i;
    }
    const std::string more = i > first ? text(", %zu pictures", i - first + 1) : "";
    out += text("<tr><td>%u</td><td>%.2f s</td><td class=%s>", c.unit, c.edge_s,
                c.outcome.starts_with("refused") ? "bad" : "ok") +
           escaped(c.outcome) + more + "</td><td>" + ms(c.to_acknowledged_ms) + "</td><td>" +
           ms(c.to_painted_ms) + "</td><td>" + escaped(c.pose) + "</td><td>" + ms(c.pose_distance_ms) +
           "</td></tr>";
  }
  return out + "</table>";
}

std::string errors_section(const RunReport& r) {
  if (r.errors.empty()) return "";
  std::string out =
      "<h2>Painting error against the simulated truth</h2><p class=muted>For every painted texel: the "
      "distance on the "
      "surface between where it lies and where the light it shows came from. Rigid error only; tissue that "
      "shifts is not "
      "in it.</p><div class=grid>";
  for (const auto& e : r.errors) {
    out += "<div class=card><b>" + escaped(e.name) + "</b>" + svg_error(e) +
           text("<div class=muted>%llu texels; mean %.3f mm, p95 %.3f mm, max %.3f mm</div></div>",
                static_cast<unsigned long long>(e.texels), e.mean_mm, e.p95_mm, e.max_mm);
  }
  return out + "</div>";
}

std::string list_section(const char* title, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  std::string out = std::string("<h2>") + title + "</h2><ul>";
  for (const auto& s : sentences) out += "<li>" + escaped(s) + "</li>";
  return out + "</ul>";
}

std::string page_of(const RunReport& r) {
  std::ostringstream out;
  out << "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport "
         "content='width=device-width'><title>"
      << escaped(r.title) << "</title><style>" << kStyle << "</style><h1>" << escaped(r.title)
      << "</h1><p class=muted>" << escaped(r.when) << " &middot; " << escaped(r.machine) << " &middot; "
      << escaped(r.renderer) << " (" << r.render_class << ") &middot; "
      << text("%.1f s, camera %.0f Hz, tracker %.0f Hz, panel %.0f Hz, %u triangles, %.2f mm a texel",
              r.duration_s, r.camera_hz, r.tracker_hz, r.panel_hz, r.triangles, r.texel_mm)
      << "</p>";
  if (r.simulated)
    out << "<p class=banner><b>SIMULATED.</b> Tracker, camera, pedal and panel were simulated; everything "
           "between them is the cart.</p>";
  out << tiles(r);
  if (!r.pictures.empty()) {
    out << "<h2>Pictures</h2>";
    for (const auto& p : r.pictures)
      out << "<p><img src='" << escaped(p) << "' alt='" << escaped(p) << "'></p>";
  }
  out << "<h2>Coverage over time</h2><div class=card>" << svg_coverage(r.coverage_over_time, r.duration_s)
      << "</div>";
  out << errors_section(r);
  out << "<h2>End to end</h2>" << cards(r.paths)
      << "<h2>Stages</h2><p class=muted>Time of one step that had work to do. Bars: logarithm of the "
         "count.</p>"
      << cards(r.stages) << "<h2>Wake-up lateness of the threads</h2>" << cards(r.wake_ups);
  out << "<h2>Captures</h2>" << captures_table(r.captures);
  out << list_section("What was dropped, late or refused, and why", r.events)
      << list_section("What keeps this machine from holding its budgets", r.degraded);
  out << "<p class=muted>orcart is for research use; it is not a medical device.</p></html>\n";
  return out.str();
}

std::string json_of(const Distribution& d) {
  return "{\"name\":" + json_string(d.name) +
         text(
             ",\"samples\":%llu,\"p50_ms\":%.6g,\"judged_quantile\":%g,\"judged_ms\":%.6g,\"max_ms\":%.6g,"
             "\"budget_ms\":%.6g,"
             "\"bound_ms\":%.6g,\"over_bound\":%llu,\"within_budget\":%s}",
             static_cast<unsigned long long>(d.samples), d.p50_ms, d.judged_quantile, d.judged_ms, d.max_ms,
             d.budget_ms, d.bound_ms, static_cast<unsigned long long>(d.over_bound),
             d.within_budget() ? "true" : "false");
}

template <class List, class ToJson>
std::string json_list(const List& list, ToJson to_json) {
  std::string out = "[";
  for (const auto& item : list) out += (out.size() > 1 ? ",\n    " : "") + to_json(item);
  return out + "]";
}

std::string json_of(const RunReport& r) {
  std::string out = "{\n  \"title\":" + json_string(r.title) + ",\n  \"cart\":" + json_string(r.cart) +
                    ",\n  \"when\":" + json_string(r.when) + ",\n  \"machine\":" + json_string(r.machine) +
                    ",\n  \"renderer\":" + json_string(r.renderer) +
                    ",\n  \"render_class\":" + json_string(r.render_class) +
                    ",\"pictures_copied_by\":" + (r.pictures_by_gpu ? "\"gpu\"" : "\"cpu\"");
  out += text(
      ",\n  "
      "\"simulated\":%s,\"duration_s\":%.3f,\"panel_hz\":%g,\"camera_hz\":%g,\"tracker_hz\":%g,\"triangles\":"
      "%u",
      r.simulated ? "true" : "false", r.duration_s, r.panel_hz, r.camera_hz, r.tracker_hz, r.triangles);
  out += text(
      ",\n  "
      "\"frames_shown\":%llu,\"frames_late\":%llu,\"late_percent\":%.4f,\"frames_dropped\":%llu,\"sequence_"
      "gaps\":%llu",
      static_cast<unsigned long long>(r.frames_shown), static_cast<unsigned long long>(r.frames_late),
      late_percent(r), static_cast<unsigned long long>(r.frames_dropped),
      static_cast<unsigned long long>(r.sequence_gaps));
  out += text(
      ",\n  \"tracker_polls\":%llu,\"tracker_missing\":%llu,\"tracker_bad_crc\":%llu,\"queue_drops\":%llu",
      static_cast<unsigned long long>(r.tracker_polls), static_cast<unsigned long long>(r.tracker_missing),
      static_cast<unsigned long long>(r.tracker_bad_crc), static_cast<unsigned long long>(r.queue_drops));
  out += text(",\n  \"resident_mb\":%.1f,\"coverage\":%.5f,\"painting_hash\":", r.resident_mb, r.coverage) +
         json_string(r.painting_hash);
  const auto sentence = [](const std::string& s) { return json_string(s); };
  out += ",\n  \"degraded\":" + json_list(r.degraded, sentence) +
         ",\n  \"events\":" + json_list(r.events, sentence);
  const auto distribution = [](const Distribution& d) { return json_of(d); };
  out += ",\n  \"paths\":" + json_list(r.paths, distribution) +
         ",\n  \"stages\":" + json_list(r.stages, distribution) +
         ",\n  \"wake_ups\":" + json_list(r.wake_ups, distribution);
  out += ",\n  \"errors\":" + json_list(r.errors, [](const PaintingError& e) {
           return "{\"name\":" + json_string(e.name) +
                  text(",\"texels\":%llu,\"mean_mm\":%.5f,\"p95_mm\":%.5f,\"max_mm\":%.5f}",
                       static_cast<unsigned long long>(e.texels), e.mean_mm, e.p95_mm, e.max_mm);
         });
  out += ",\n  \"captures\":" + json_list(r.captures, [](const CaptureRow& c) {
           return text(
                      "{\"unit\":%u,\"edge_s\":%.6f,\"to_acknowledged_ms\":%.3f,\"to_painted_ms\":%.3f,"
                      "\"outcome\":",
                      c.unit, c.edge_s, c.to_acknowledged_ms, c.to_painted_ms) +
                  json_string(c.outcome) + "}";
         });
  return out + "\n}\n";
}

}  // namespace

Result<void> write_report(const std::filesystem::path& dir, const RunReport& report) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error) return fail("the report's folder " + dir.string() + " cannot be made: " + error.message());
  if (auto page = write_whole_file(dir / "report.html", page_of(report)); !page) return page;
  return write_whole_file(dir / "report.json", json_of(report));
}

std::string summary_of(const RunReport& r, const std::filesystem::path& dir) {
  std::uint64_t painted = 0, other = 0;
  for (const auto& c : r.captures) (c.outcome.starts_with("painted") ? painted : other) += 1;
  std::string out;
  out +=
      text("%.0f s of %s procedure: %llu frames shown, %llu pictures painted, %llu undone or refused.\n",
           r.duration_s, r.simulated ? "simulated" : "real", static_cast<unsigned long long>(r.frames_shown),
           static_cast<unsigned long long>(painted), static_cast<unsigned long long>(other));
  out += text("%.1f %% of the surface is covered.\n", 100 * r.coverage);
  for (const auto& e : r.errors)
    out += text("Painting error, %s: mean %.3f mm, max %.3f mm.\n", e.name.c_str(), e.mean_mm, e.max_mm);
  out += text("Late frames: %.2f %% (%llu of %llu); resident memory %.0f MB; %s rendering.\n",
              late_percent(r), static_cast<unsigned long long>(r.frames_late),
              static_cast<unsigned long long>(r.frames_shown), r.resident_mb, r.render_class.c_str());
  for (const auto& p : r.paths) {
    if (p.samples == 0) continue;
    out += text("%s: p50 %.1f ms", p.name.c_str(), p.p50_ms);
    if (p.judged_quantile > 0.5) out += text(", p%g %.1f ms", 100 * p.judged_quantile, p.judged_ms);
    out += text(" of %llu.\n", static_cast<unsigned long long>(p.samples));
  }
  if (!r.degraded.empty()) out += text("DEGRADED: %zu reasons, in the report.\n", r.degraded.size());
  if (!dir.empty()) out += "Report: " + (dir / "report.html").string() + "\n";
  return out;
}

}  // namespace orcart
