// From files to the map and its sentence.
#include "tools/evaluate/texels/error_map.hpp"

#include <chrono>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/textured_file.hpp"
#include "firmware-host/offline/offline_painter.hpp"
#include "firmware-host/offline/texel_values.hpp"
#include "tools/evaluate/marker_bodies.hpp"
#include "tools/evaluate/stated_errors.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {

namespace {

Result<void> paint_all(OfflinePainter& painter, const std::vector<View>& views,
                       const EvaluateProgress& progress) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    progress("painting", static_cast<double>(i) / static_cast<double>(views.size()));
    auto picture = read_picture(views[i].image);
    if (!picture) return tl::unexpected(picture.error());
    if (const auto painted = painter.paint(picture->descriptor(), views[i].X_MC, views[i].turn_rad); !painted)
      return fail(views[i].image.string() + ": " + painted.error().message);
  }
  return {};
}

Result<void> write_map(const std::filesystem::path& out, const TexelValues& shown, const Surface& surface,
                       const EvaluationScene& scene, const Pose<M, C>& last) {
  if (out.extension() == ".png") {
    const Picture picture = seen_by_scope(shown, surface.mesh, scene.rays, scene.scope, last);
    return write_png(out, picture.width_px, picture.height_px, picture.rgba);
  }
  const AtlasPicture colours = colours_of(shown);
  return write_textured(out, {.surface = surface,
                              .corners_uv = picture_places(shown.layout),
                              .width_texels = colours.width_texels,
                              .height_texels = colours.height_texels,
                              .rgba = colours.rgba});
}

void summarise(const AtlasLayout& layout, const std::vector<float>& rms_mm, ErrorMapReport& report) {
  std::vector<double> values;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < rms_mm.size(); ++i) {
    inside += layout.inside[i];
    if (rms_mm[i] >= 0) values.push_back(static_cast<double>(rms_mm[i]));
  }
  report.texels = values.size();
  report.texel_mm = layout.texel_mm;
  report.coverage = inside > 0 ? static_cast<double>(values.size()) / static_cast<double>(inside) : 0;
  report.rms_mm = statistics_of(values, {});
}

}  // namespace

Result<ErrorMapReport> make_error_map(const ErrorMapCommand& command, const EvaluateProgress& progress) {
  const auto began = std::chrono::steady_clock::now();
  const auto surface = read_surface(command.surface);
  if (!surface) return tl::unexpected(surface.error());
  const auto scope = read_scope(command.scope);
  if (!scope) return tl::unexpected(scope.error());
  if (auto told = check_turn_told(command.model, *scope); !told) return tl::unexpected(told.error());
  const auto registration = read_registration(command.registration);
  if (!registration) return tl::unexpected(registration.error());
  if (auto own = check_surface(*registration, surface->identity.hash); !own)
    return fail(command.registration.string() + ": " + own.error().message);
  auto scope_markers = markers_of_body(command.scope_rom),
       reference_markers = markers_of_body(command.reference_rom);
  if (!scope_markers) return tl::unexpected(scope_markers.error());
  if (!reference_markers) return tl::unexpected(reference_markers.error());
  const auto views = read_views(command.views);
  if (!views) return tl::unexpected(views.error());
  if (auto turns = check_turns(views->views, *scope, command.views); !turns)
    return tl::unexpected(turns.error());
  auto rays = RayScene::create(surface->mesh);
  if (!rays) return tl::unexpected(rays.error());
  const EvaluationScene scene{.mesh = surface->mesh,
                              .rays = *rays,
                              .scope = *scope,
                              .seen_from = command.seen_from,
                              .X_MR = registration->X_MR,
                              .scope_markers_mm = *std::move(scope_markers),
                              .reference_markers_mm = *std::move(reference_markers)};
  auto painter = OfflinePainter::create(*surface, *scope,
                                        {.seen_from = command.seen_from, .texel_mm = command.texel_mm});
  if (!painter) return tl::unexpected(painter.error());
  if (auto painted = paint_all(*painter, views->views, progress); !painted)
    return tl::unexpected(painted.error());
  const AtlasRecords records = painter->painter().read_records();
  TurnedScenes scenes(scene, command.model, *registration);
  const PaintedTexels painted{.layout = painter->layout(),
                              .records = records,
                              .views = views->views,
                              .scenes = scenes_of(views->views, scenes)};
  RandomStream random(command.seed, 5'000'000);
  const auto fiducials = fiducials_of_chance(scene, command.model.fiducials, random);
  progress("predicting", 0);
  const ErrorModel model = with_stated(command.model, *scope, *registration);
  const std::vector<float> rms_mm = predicted_rms_mm(fiducials, painted);
  ErrorMapReport report{.model = model,
                        .out = command.out,
                        .views = views->views.size(),
                        .velocities = velocities_of(views->views),
                        .setups = command.setups};
  summarise(painter->layout(), rms_mm, report);
  if (report.texels == 0)
    return fail(command.out.string() + " is not written: none of the " + std::to_string(report.views) +
                " views painted anything; check the poses and --seen-from");
  progress("checking by draws", 0.5);
  report.drawn = drawn_coverage(fiducials, painted, command.setups, random);
  const TexelValues shown{
      .layout = painter->layout(), .values = rms_mm, .darkest = ErrorMapReport::kDarkest_mm};
  if (auto written =
          write_map(command.out, shown, *surface, painted.scenes.back()->scene, views->views.back().X_MC);
      !written)
    return tl::unexpected(written.error());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return report;
}

std::string text_of(const ErrorMapReport& r) {
  return "errors: " + sources_text(r.model) + "\n" + text_of(r.velocities) + "\n" +
         json::format("%zu views, %zu painted texels of %.2f mm, %.1f %% of the surface\n", r.views, r.texels,
                      r.texel_mm, 100 * r.coverage) +
         json::format("predicted error, mm RMS: mean %.3f, p95 %.3f, max %.2f\n", r.rms_mm.mean, r.rms_mm.p95,
                      r.rms_mm.max) +
         json::format(
             "its 95 %% ellipse holds %.1f %% of %zu errors drawn in %d set-ups (%zu more landed on "
             "another fold, %zu beside all)\n",
             100 * r.drawn.coverage.share(), r.drawn.coverage.points, r.setups, r.drawn.jumped,
             r.drawn.lost) +
         r.out.string() +
         json::format(": yellow is 0, violet %g mm and beyond\n", ErrorMapReport::kDarkest_mm) +
         "Rigid errors only: tissue that has shifted is not in these figures.\n";
}

std::string json_of(const ErrorMapReport& r) {
  return "{\"errors_from\": " + sources_json(r.model) + ", \"velocity\": " + json_of(r.velocities) +
         json::format(
             ", \"views\": %zu, \"texels\": %zu, \"texel_mm\": %.4f, \"coverage\": %.4f, "
             "\"predicted_rms\": {\"mean_mm\": %.4f, \"p95_mm\": %.4f, \"max_mm\": %.4f}, ",
             r.views, r.texels, r.texel_mm, r.coverage, r.rms_mm.mean, r.rms_mm.p95, r.rms_mm.max) +
         json::format(
             "\"setups\": %d, \"coverage95\": %.4f, \"coverage95_points\": %zu, "
             "\"landed_on_another_fold\": %zu, \"lost\": %zu, \"seconds\": %.2f, \"out\": ",
             r.setups, r.drawn.coverage.share(), r.drawn.coverage.points, r.drawn.jumped, r.drawn.lost,
             r.seconds) +
         json::text(r.out.string()) + "}\n";
}

}  // namespace orcart
