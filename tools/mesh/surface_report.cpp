// The report of a surface in its three forms.
#include "tools/mesh/surface_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware-host/files/whole_file.hpp"
#include "tools/mesh/mesh_pictures.hpp"

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

std::string escaped(const std::string& s) {
  std::string out;
  for (const char c : s) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string json_of(const MeshDistance& d) {
  return text("{\"mean_mm\": %.4f, \"p95_mm\": %.4f, \"max_mm\": %.4f, \"points\": %zu}", d.mean_mm, d.p95_mm,
              d.max_mm, d.points);
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><th>" + name + "</th><td>" + escaped(value) + "</td></tr>\n";
}

/// The region's volume over its range; a leak is a step.
std::string curve_svg(const GrowthReport& growth) {
  constexpr double kWidth = 520, kHeight = 150, kLeft = 60, kBottom = 24;
  const double most = std::max(*std::max_element(growth.curve_ml.begin(), growth.curve_ml.end()), 1e-9);
  std::string line;
  const double last = static_cast<double>(growth.curve_ml.size() - 1);
  for (std::size_t i = 0; i < growth.curve_ml.size(); ++i)
    line += text("%.1f,%.1f ", kLeft + (kWidth - kLeft - 8) * static_cast<double>(i) / last,
                 kHeight - kBottom - (kHeight - kBottom - 12) * growth.curve_ml[i] / most);
  return text("<svg viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\">", kWidth, kHeight, kWidth,
              kHeight) +
         "<polyline fill=\"none\" stroke=\"#1f6f8b\" stroke-width=\"2\" points=\"" + line + "\"/>" +
         text(
             "<text x=\"2\" y=\"18\" font-size=\"11\">%.4g ml</text><text x=\"2\" y=\"%.0f\" "
             "font-size=\"11\">0</text><text x=\"%.0f\" y=\"%.0f\" font-size=\"11\">seeds' "
             "intensity</text><text x=\"%.0f\" y=\"%.0f\" font-size=\"11\" text-anchor=\"end\">whole range "
             "%g to %g</text></svg>\n",
             most, kHeight - kBottom, kLeft, kHeight - 6, kWidth - 8, kHeight - 6, growth.lowest,
             growth.highest);
}

std::string shape_of(const SurfaceReport& report) {
  const MeshFigures& m = report.mesh;
  return text("%.2f ml, %.0f mm2, Euler number %ld, %s, %zu piece%s", m.volume_ml, m.area_mm2, m.euler_number,
              report.closed ? "closed" : "open", m.components, m.components == 1 ? "" : "s");
}

std::string deviation_of(const SurfaceReport& report) {
  return text("thinned out from %zu triangles: %.3f mm mean, %.3f p95, %.3f max (%zu points)",
              report.triangles_before, report.thinning.mean_mm, report.thinning.p95_mm,
              report.thinning.max_mm, report.thinning.points);
}

std::string box_of(const MeshFigures& m) {
  const auto d = [](float x) { return static_cast<double>(x); };
  return text("x %.1f..%.1f, y %.1f..%.1f, z %.1f..%.1f mm LPS", d(m.lowest_mm.x()), d(m.highest_mm.x()),
              d(m.lowest_mm.y()), d(m.highest_mm.y()), d(m.lowest_mm.z()), d(m.highest_mm.z()));
}

constexpr const char* kStyle =
    "<style>body{font:15px/1.5 system-ui,sans-serif;max-width:1020px;margin:2em auto;padding:0 1em;"
    "color:#1c1f24}table{border-collapse:collapse}th{text-align:left;padding:.2em 1.5em .2em 0;font-weight:"
    "600;vertical-align:top}td{padding:.2em 0}figure{display:inline-block;margin:0 12px 12px "
    "0;vertical-align:"
    "top}figcaption{font-size:13px;color:#555}img{max-width:320px;height:auto;background:#fff}</style>";

}  // namespace

std::string text_of(const SurfaceReport& report) {
  std::string out = text("source      %s (%s)\n", report.source.c_str(), report.kind.c_str());
  if (report.growth)
    out += text("region      %.2f ml (%zu voxels of it filled gaps and cavities)\n", report.growth->region_ml,
                report.growth->filled_voxels);
  out += "surface     " + shape_of(report) + "\n            " + box_of(report.mesh) + "\n";
  out += text("            %zu vertices, %zu triangles\n", report.mesh.vertices, report.mesh.triangles);
  if (report.thinning.points > 0) out += "deviation   " + deviation_of(report) + "\n";
  if (report.growth)
    out += text("            smoothing moved a vertex by %.3f mm at most\n", report.smoothing_max_mm);
  for (const SurfaceLevel& level : report.levels)
    out += text("level       %s: %zu triangles, %.3f mm mean, %.3f max\n",
                level.file.filename().string().c_str(), level.triangles, level.deviation.mean_mm,
                level.deviation.max_mm);
  if (report.charts)
    out += text("charts      %s: %zu in %dx%d texels of %.3g mm, of which %.0f %% are used\n",
                report.charts->file.filename().string().c_str(), report.charts->charts,
                report.charts->size_texels, report.charts->size_texels, report.charts->texel_mm,
                100 * report.charts->used_share);
  for (const std::string& note : report.notes) out += "note        " + note + "\n";
  out += "hash        " + report.identity.hash + "\nseries      " + report.identity.series + "\n";
  if (!report.identity.frame_of_reference.empty())
    out += "frame       " + report.identity.frame_of_reference + "\n";
  return out + text("written     %s in %.1f s\n", report.out.string().c_str(), report.seconds);
}

std::string json_of(const SurfaceReport& report) {
  const MeshFigures& m = report.mesh;
  std::string out = "{\"source\": " + quoted(report.source) + ", \"kind\": " + quoted(report.kind) +
                    ", \"out\": " + quoted(report.out.string()) + ",\n ";
  if (report.growth) {
    out += text("\"region_ml\": %.3f, \"filled_voxels\": %zu, \"growth_ml\": [", report.growth->region_ml,
                report.growth->filled_voxels);
    for (std::size_t i = 0; i < report.growth->curve_ml.size(); ++i)
      out += text(i == 0 ? "%.4g" : ", %.4g", report.growth->curve_ml[i]);
    out += "],\n ";
  }
  out += text("\"volume_ml\": %.3f, \"area_mm2\": %.1f, \"euler_number\": %ld, \"closed\": %s, ", m.volume_ml,
              m.area_mm2, m.euler_number, report.closed ? "true" : "false");
  out += text("\"vertices\": %zu, \"edges\": %zu, \"triangles\": %zu, \"components\": %zu,\n ", m.vertices,
              m.edges, m.triangles, m.components);
  out += text(
      "\"open_edges\": %zu, \"crowded_edges\": %zu, \"misturned_edges\": %zu, \"piercing_edges\": %zu,\n ",
      m.open_edges, m.crowded_edges, m.misturned_edges, m.piercing_edges);
  out +=
      text("\"triangles_before\": %zu, \"smoothing_max_mm\": %.4f, \"deviation\": ", report.triangles_before,
           report.smoothing_max_mm) +
      json_of(report.thinning) + ",\n \"levels\": [";
  for (std::size_t i = 0; i < report.levels.size(); ++i)
    out += std::string(i == 0 ? "" : ", ") + "{\"file\": " + quoted(report.levels[i].file.string()) +
           text(", \"triangles\": %zu, \"deviation\": ", report.levels[i].triangles) +
           json_of(report.levels[i].deviation) + "}";
  out += "],\n ";
  if (report.charts)
    out += "\"charts\": {\"file\": " + quoted(report.charts->file.string()) +
           text(", \"count\": %zu, \"size_texels\": %d, \"texel_mm\": %.4f, \"used_share\": %.4f},\n ",
                report.charts->charts, report.charts->size_texels, report.charts->texel_mm,
                report.charts->used_share);
  out += "\"notes\": [";
  for (std::size_t i = 0; i < report.notes.size(); ++i) out += (i == 0 ? "" : ", ") + quoted(report.notes[i]);
  return out + "],\n \"hash\": " + quoted(report.identity.hash) +
         ", \"series\": " + quoted(report.identity.series) +
         ", \"frame_of_reference\": " + quoted(report.identity.frame_of_reference) +
         text(", \"seconds\": %.2f}\n", report.seconds);
}

Result<void> write_page(const std::filesystem::path& dir, const SurfaceReport& report) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error) return fail(dir.string() + ": cannot be made: " + error.message());
  std::string page = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" +
                     escaped(report.out.filename().string()) + "</title>" + kStyle + "<h1>" +
                     escaped(report.out.filename().string()) +
                     "</h1>\n<p>Research use only; not a medical device.</p>\n<table>\n";
  page += row("from", report.source + " (" + report.kind + ")") + row("series", report.identity.series) +
          row("frame of reference", report.identity.frame_of_reference) + row("hash", report.identity.hash) +
          row("surface", shape_of(report)) + row("where", box_of(report.mesh)) +
          row("triangles", std::to_string(report.mesh.triangles));
  if (report.thinning.points > 0) page += row("deviation", deviation_of(report));
  if (report.growth)
    page += row("region", text("%.2f ml from %g to %g; smoothing moved a vertex by %.3f mm at most",
                               report.growth->region_ml, report.growth->lowest, report.growth->highest,
                               report.smoothing_max_mm));
  for (const std::string& note : report.notes) page += row("note", note);
  page += "</table>\n";
  if (report.growth)
    page += "<h2>The region's volume while its range widens</h2>\n" + curve_svg(*report.growth);
  page += "<h2>Pictures</h2>\n";
  for (const CaptionedPicture& picture : report.pictures) {
    const auto written = write_png(dir / picture.name, picture.picture.width_px, picture.picture.height_px,
                                   picture.picture.rgba);
    if (!written) return written;
    page += "<figure><img src=\"" + picture.name + "\" alt=\"\"><figcaption>" + escaped(picture.caption) +
            "</figcaption></figure>\n";
  }
  if (auto written = write_whole_file(dir / "surface.json", json_of(report)); !written) return written;
  return write_whole_file(dir / "surface.html", page + "</html>\n");
}

Result<std::vector<CaptionedPicture>> pictures_of(const TriangleMesh& mesh) {
  const auto rays = RayScene::create(mesh);
  if (!rays) return tl::unexpected(rays.error());
  struct Side {
    const char* name;
    const char* caption;
    Eigen::Vector3f from, up;
  };
  const std::array<Side, 3> sides{Side{"from-left.png", "from the patient's left", {1, 0, 0}, {0, 0, 1}},
                                  Side{"from-front.png", "from the front", {0, -1, 0}, {0, 0, 1}},
                                  Side{"from-above.png", "from above, front on top", {0, 0, 1}, {0, -1, 0}}};
  std::vector<CaptionedPicture> pictures;
  for (const Side& side : sides)
    pictures.push_back({.name = side.name,
                        .caption = side.caption,
                        .picture = draw_mesh(mesh, *rays, {.from = side.from, .up = side.up})});
  return pictures;
}

}  // namespace orcart
