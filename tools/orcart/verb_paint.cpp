// orcart paint: recorded pictures with their poses, painted onto a surface, from files to files.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/textured_file.hpp"
#include "firmware-host/files/views_file.hpp"
#include "firmware-host/offline/offline_painter.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "render/atlas/colouring.hpp"
#include "tools/orcart/paint_difference.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n"
    "  orcart paint --surface ventricle.ply --seen-from inside --scope scope.toml --views views.csv --out "
    "painted.obj\n\n"
    "views.csv has a line for each picture, the newest last (it wins): image,m00,m01,...,m23 with the "
    "camera's pose\n"
    "in the surface's space as a row-major 3x4 matrix, mm (LPS); then, where there is something to tell, "
    "turn_rad of an\nangled scope's light post, and how fast the scope moved (vx_mm_s,vy_mm_s,vz_mm_s,"
    "wx_rad_s,wy_rad_s,wz_rad_s, in the\ncamera's axes), for `orcart evaluate`. Writes NAME.obj, NAME.mtl "
    "and NAME.png, "
    "NAME.ply\n"
    "and NAME.png, or NAME.glb alone.\n\n"
    "How far paper mode puts the same light from where it belongs, in mm over the views' cutouts, as colours "
    "on "
    "the\n"
    "surface (.obj, .ply, .glb) or as the last view sees it (.png):\n"
    "  orcart paint --surface ventricle.ply --seen-from inside --scope scope.toml --views views.csv --out "
    "painted.obj \\\n"
    "    --difference difference.png";

struct Arguments {
  std::string surface, scope, views, out;
  std::string difference;  ///< empty: not asked for
  OfflinePaintOptions options;
  ColourBy colour_by = ColourBy::picture;
  std::optional<Space> space;
  double turn_deg = 0;
  bool json = false;
};

struct Summary {
  std::size_t views = 0, views_without_paint = 0;
  double coverage = 0;  ///< share of the surface's texels that carry paint, 0..1
  double texel_mm = 0;
  int atlas_size_texels = 0;
  double footprint_mm = 0, angle_deg = 0, error_mm = 0;  ///< medians over the painted texels
  double seconds = 0;
  std::string renderer;
  std::optional<ModeDifference> difference;
};

void warn(const std::string& sentence) {
  std::fprintf(stderr, "orcart paint: %s\n", sentence.c_str());
}

void warn(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) warn(sentence);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A bar on a terminal's stderr, once the work has taken two seconds.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t steps) : steps_(steps) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::size_t done) {
    if (!terminal_ || seconds_since(start_) < 2) return;
    constexpr std::size_t kWidth = 40;
    const std::string bar(done * kWidth / steps_, '#');
    std::fprintf(stderr, "\r[%-40s] %zu of %zu views", bar.c_str(), done, steps_);
    shown_ = true;
  }
  /// Makes room for a sentence.
  void clear() {
    if (std::exchange(shown_, false)) std::fputs("\r\x1b[K", stderr);
  }

 private:
  std::size_t steps_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool terminal_ = ::isatty(STDERR_FILENO) == 1, shown_ = false;
};

/// What is read before any painting starts.
struct Inputs {
  Surface surface;
  ScopeModel scope;
  std::vector<View> views;
};

Result<Surface> read_surface_of(const Arguments& arguments) {
  SurfaceNotes notes;
  auto surface = read_surface(arguments.surface, &notes, arguments.space);
  if (!surface && !arguments.space && read_surface(arguments.surface, nullptr, Space::lps))
    return fail(surface.error().message + " with --space lps or --space ras");
  warn(notes.sentences);
  return surface;
}

std::filesystem::path whole_path(const std::filesystem::path& file) {
  std::error_code error;
  const auto path = std::filesystem::weakly_canonical(file, error);
  return error ? file : path;
}

/// Refuses names of which two files would be written, or that something stands under which is read. The
/// surface may be painted over: it stays the same surface.
Result<void> check_names(const Arguments& arguments, const std::vector<View>& views) {
  const auto painting = textured_files(arguments.out);
  std::vector<std::filesystem::path> difference;
  if (arguments.difference.ends_with(".png"))
    difference = {arguments.difference};
  else if (!arguments.difference.empty())
    difference = textured_files(arguments.difference);
  std::set<std::filesystem::path> written, read = {whole_path(arguments.scope), whole_path(arguments.views)};
  for (const View& view : views) read.insert(whole_path(view.image));
  for (const auto& file : painting) written.insert(whole_path(file));
  for (const auto& file : difference)
    if (written.contains(whole_path(file)))
      return fail(file.string() +
                  ": would hold the painting and the difference; a --difference whose name differs from "
                  "--out's before its ending is expected");
  for (const auto& file : difference) written.insert(whole_path(file));
  for (const auto& file : written)
    if (read.contains(file))
      return fail(file.string() + ": is read, and would be written over; another name is expected");
  return {};
}

Result<Inputs> read_inputs(const Arguments& arguments) {
  auto surface = read_surface_of(arguments);
  if (!surface) return tl::unexpected(surface.error());
  std::vector<std::string> scope_notes;
  auto scope = read_scope(arguments.scope, &scope_notes);
  if (!scope) return tl::unexpected(scope.error());
  warn(scope_notes);
  if (arguments.turn_deg != 0 && !scope->turning)
    return fail(arguments.scope + ": the passport has no [turning], so --turn means nothing");
  *scope = turned(*scope, arguments.turn_deg * std::numbers::pi / 180);
  auto views = read_views(arguments.views);
  if (!views) return tl::unexpected(views.error());
  warn(views->notes);
  if (auto names = check_names(arguments, views->views); !names) return tl::unexpected(names.error());
  if (auto turns = check_turns(views->views, *scope, arguments.views); !turns)
    return tl::unexpected(turns.error());
  return Inputs{std::move(*surface), std::move(*scope), std::move(views->views)};
}

/// How many views painted nothing.
Result<std::size_t> paint_views(OfflinePainter& painter, const Inputs& inputs, const Arguments& arguments) {
  const char* other_side = arguments.options.seen_from == SeenFrom::inside ? "outside" : "inside";
  std::size_t without_paint = 0;
  ProgressBar bar(inputs.views.size());
  for (std::size_t i = 0; i < inputs.views.size(); ++i) {
    const View& view = inputs.views[i];
    bar.show(i);
    auto picture = read_picture(view.image);
    if (!picture) return tl::unexpected(picture.error());
    const auto painted = painter.paint(picture->descriptor(), view.X_MC, view.turn_rad);
    if (!painted) return fail(view.image.string() + ": " + painted.error().message);
    if (painted->triangles > 0) continue;
    ++without_paint;
    bar.clear();
    warn(view.image.string() + " painted nothing: no triangle within " +
         std::to_string(static_cast<int>(inputs.scope.far_mm)) +
         " mm faces the scope there; check the pose, or try --seen-from " + other_side);
  }
  return without_paint;
}

double median_of(std::vector<std::uint16_t> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void add_medians(const AtlasLayout& layout, const AtlasRecords& records, Summary& summary) {
  std::vector<std::uint16_t> footprints, angles, errors;
  for (std::size_t i = 0; i < layout.inside.size(); ++i) {
    const TexelRecord& record = records.texels[i];
    if (layout.inside[i] == 0 || record.capture == 0) continue;
    footprints.push_back(record.footprint_um);
    angles.push_back(record.angle_cdeg);
    errors.push_back(record.error_um);
  }
  summary.footprint_mm = median_of(std::move(footprints)) / 1000;
  summary.angle_deg = median_of(std::move(angles)) / 100;
  summary.error_mm = median_of(std::move(errors)) / 1000;
}

double share_painted(const AtlasLayout& layout, const AtlasPicture& picture) {
  std::size_t inside = 0, painted = 0;
  for (std::size_t i = 0; i < layout.inside.size(); ++i) {
    if (layout.inside[i] == 0) continue;
    ++inside;
    painted += picture.rgba[4 * i + 3] > 0 ? 1 : 0;
  }
  return inside > 0 ? static_cast<double>(painted) / static_cast<double>(inside) : 0;
}

Result<Summary> paint(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const auto inputs = read_inputs(arguments);
  if (!inputs) return tl::unexpected(inputs.error());
  auto painter = OfflinePainter::create(inputs->surface, inputs->scope, arguments.options);
  if (!painter) return tl::unexpected(painter.error());
  const auto without_paint = paint_views(*painter, *inputs, arguments);
  if (!without_paint) return tl::unexpected(without_paint.error());
  const AtlasLayout& layout = painter->layout();
  const AtlasPicture picture = painter->painter().read_back();
  const double coverage = share_painted(layout, picture);
  if (coverage == 0)
    return fail(arguments.out + " is not written: none of the " + std::to_string(inputs->views.size()) +
                " views painted anything");
  const AtlasRecords records = painter->painter().read_records();
  const AtlasPicture shown = coloured(picture, records, arguments.colour_by);
  const auto places = picture_places(layout);
  std::optional<DifferenceMap> difference;
  if (!arguments.difference.empty()) {
    auto map =
        difference_of(inputs->surface, inputs->scope, layout, arguments.options.seen_from, inputs->views);
    if (!map) return tl::unexpected(map.error());
    difference = *std::move(map);
  }
  const auto written = write_textured(arguments.out, {.surface = inputs->surface,
                                                      .corners_uv = places,
                                                      .width_texels = picture.width_texels,
                                                      .height_texels = picture.height_texels,
                                                      .rgba = shown.rgba});
  if (!written) return tl::unexpected(written.error());
  if (difference)
    if (auto done = write_difference(arguments.difference, *difference, inputs->surface, places,
                                     inputs->views.back());
        !done)
      return tl::unexpected(done.error());
  Summary summary{.views = inputs->views.size(),
                  .views_without_paint = *without_paint,
                  .coverage = coverage,
                  .texel_mm = layout.texel_mm,
                  .atlas_size_texels = layout.width_texels,
                  .seconds = seconds_since(start),
                  .renderer = painter->context().renderer_name(),
                  .difference = {}};
  if (difference) summary.difference = difference->figures();
  add_medians(layout, records, summary);
  return summary;
}

void print(const Summary& summary, const Arguments& arguments) {
  std::printf(
      "%zu views painted in %.1f s (%s), %.1f %% of the surface covered, texels of %.3g mm in %dx%d: %s\n",
      summary.views - summary.views_without_paint, summary.seconds, summary.renderer.c_str(),
      100 * summary.coverage, summary.texel_mm, summary.atlas_size_texels, summary.atlas_size_texels,
      arguments.out.c_str());
  std::printf(
      "a pixel covers %.3g mm of the surface, seen %.0f degrees from its normal; predicted error %.3g mm "
      "(medians)\n",
      summary.footprint_mm, summary.angle_deg, summary.error_mm);
  if (summary.difference) std::puts(difference_text(*summary.difference, arguments.difference).c_str());
  if (const double end = end_of_ramp(arguments.colour_by); end > 0)
    std::printf("colours: yellow is 0, violet %g %s and beyond\n", end,
                arguments.colour_by == ColourBy::angle ? "degrees" : "mm");
}

std::string json_text(const std::string& words) {
  std::string out = "\"";
  for (const char c : words) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + "\"";
}

void print_json(const Summary& summary, const Arguments& arguments) {
  std::printf(
      "{\"views\": %zu, \"views_without_paint\": %zu, \"coverage\": %.6f, \"texel_mm\": %.6g, "
      "\"atlas_size_texels\": %d, \"footprint_mm_median\": %.4f, \"angle_deg_median\": %.2f, "
      "\"predicted_error_mm_median\": %.4f, %s\"seconds\": %.3f, \"renderer\": %s, \"out\": %s}\n",
      summary.views, summary.views_without_paint, summary.coverage, summary.texel_mm,
      summary.atlas_size_texels, summary.footprint_mm, summary.angle_deg, summary.error_mm,
      summary.difference ? difference_json(*summary.difference).c_str() : "", summary.seconds,
      json_text(summary.renderer).c_str(), json_text(arguments.out).c_str());
}

int run(const Arguments& arguments) {
  const auto summary = paint(arguments);
  if (!summary) {
    warn(summary.error().message);
    return 1;
  }
  arguments.json ? print_json(*summary, arguments) : print(*summary, arguments);
  return 0;
}

std::string writable_kind(const std::string& out) {
  for (const char* kind : {".obj", ".ply", ".glb"})
    if (out.ends_with(kind)) return "";
  return "a name that ends in .obj, .ply or .glb is accepted";
}

void add_painting_options(CLI::App& verb, Arguments& arguments) {
  verb.add_option("--policy", arguments.options.policy,
                  "newest (default): the newest picture wins; best: the one in which a pixel covers least")
      ->transform(one_of<PaintPolicy>({{"newest", PaintPolicy::newest}, {"best", PaintPolicy::best}}));
  verb.add_option("--highlights", arguments.options.highlights,
                  "keep (default), or yield: mirrored light gives way to any other picture")
      ->transform(one_of<Highlights>({{"keep", Highlights::keep}, {"yield", Highlights::yield}}));
  verb.add_option(
          "--light", arguments.options.light,
          "as_seen (default); the light's fall evened out: fixed_exposure, or auto_exposure where the "
          "camera sets its gain")
      ->transform(one_of<LightModel>({{"as_seen", LightModel::as_seen},
                                      {"fixed_exposure", LightModel::fixed_exposure},
                                      {"auto_exposure", LightModel::auto_exposure}}));
  verb.add_option("--colour-by", arguments.colour_by,
                  "picture (default), or what is known of each texel: capture, angle, resolution, error")
      ->transform(one_of<ColourBy>({{"picture", ColourBy::picture},
                                    {"capture", ColourBy::capture},
                                    {"angle", ColourBy::angle},
                                    {"resolution", ColourBy::resolution},
                                    {"error", ColourBy::error}}));
}

}  // namespace

void add_paint(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("paint", "Paint recorded pictures with known poses onto a surface");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("--surface", arguments->surface, "PLY, STL, OBJ or mz3, mm")->required();
  verb->add_option("--scope", arguments->scope, "scope.toml, the calibration passport")->required();
  verb->add_option("--turn", arguments->turn_deg,
                   "degrees by which the pictures had turned since the passport was made");
  verb->add_option("--views", arguments->views, "views.csv")->required();
  verb->add_option("--mode", arguments->options.mode,
                   "perspective (default): through the calibrated lens; paper: as Dey et al. 2000")
      ->transform(
          one_of<TextureMode>({{"perspective", TextureMode::perspective}, {"paper", TextureMode::paper}}));
  add_painting_options(*verb, *arguments);
  verb->add_option("--seen-from", arguments->options.seen_from, "outside (default) or inside")
      ->transform(one_of<SeenFrom>({{"outside", SeenFrom::outside}, {"inside", SeenFrom::inside}}));
  verb->add_option("--texel-mm", arguments->options.texel_mm,
                   "size of the paint's texels; made coarser where the surface would not fit")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  verb->add_option_function<Space>(
          "--space", [arguments](const Space& space) { arguments->space = space; },
          "lps or ras: the space of a surface that states none")
      ->transform(one_of<Space>({{"lps", Space::lps}, {"ras", Space::ras}}));
  verb->add_option("--out", arguments->out, "NAME.obj, NAME.ply or NAME.glb")
      ->required()
      ->check(CLI::Validator(writable_kind, "NAME.obj|NAME.ply|NAME.glb"));
  verb->add_option("--difference", arguments->difference,
                   "paper mode against perspective, in mm: NAME.obj, .ply, .glb, or a picture NAME.png")
      ->check(CLI::Validator(
          [](std::string& file) { return file.ends_with(".png") ? std::string() : writable_kind(file); },
          "NAME.png|NAME.obj|NAME.ply|NAME.glb"));
  verb->add_flag("--json", arguments->json, "the summary as one JSON object");
  verb->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace orcart
