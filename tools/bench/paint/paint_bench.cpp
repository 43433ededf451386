// Every pose is a capture of its own; its frames follow each other as a stream's do.
#include "tools/bench/paint/paint_bench.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>

#include "realtime/mapper/cutout.hpp"
#include "render/egl/context.hpp"
#include "render/views/screen.hpp"

namespace orcart {
namespace {

constexpr int kWidth = 1920, kHeight = 1080, kPanelWidth = 1280, kPanelHeight = 800;
constexpr std::size_t kFrames = 3;  // different ones, in turn

ScopeModel scope_for(const PaintBenchSettings& settings) {
  ScopeModel scope{.name = "bench", .width_px = kWidth, .height_px = kHeight};
  const double focal_px = kHeight / 2.0 / std::tan(settings.cone_half_angle_rad);
  scope.lens = {
      .fx_px = focal_px, .fy_px = focal_px, .cx_px = (kWidth - 1) / 2.0, .cy_px = (kHeight - 1) / 2.0};
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.5);
  scope.mask = {.cx_px = scope.lens.cx_px, .cy_px = scope.lens.cy_px, .radius_px = kHeight / 2.0};
  scope.cone_half_angle_rad = settings.cone_half_angle_rad;
  scope.far_mm = settings.far_mm;
  return scope;
}

/// Bytes of an NV12 picture with structure at every scale.
std::vector<std::byte> nv12_frame(std::size_t number) {
  std::vector<std::byte> bytes(packed_bytes(PixelFormat::nv12, kWidth, kHeight), std::byte{120});
  for (std::size_t i = 0; i < static_cast<std::size_t>(kWidth) * kHeight; ++i) {
    const std::size_t x = i % kWidth, y = i / kWidth;
    bytes[i] = static_cast<std::byte>(60 + ((x * 7) ^ (y * 5) ^ (number * 31)) % 97 + x / 40);
  }
  return bytes;
}

struct Took {
  double wall_ms = 0, cpu_ms = 0;
};
Took operator+(const Took& a, const Took& b) {
  return {a.wall_ms + b.wall_ms, a.cpu_ms + b.cpu_ms};
}

Took time_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  work();
  return {std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(),
          1000.0 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC};
}

double at_share(const std::vector<double>& sorted, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
  return sorted[std::min(sorted.size() - 1, at)];
}

Spread spread_of(const std::vector<Took>& samples) {
  if (samples.empty()) return {};
  std::vector<double> wall, cpu;
  for (const Took& took : samples) {
    wall.push_back(took.wall_ms);
    cpu.push_back(took.cpu_ms);
  }
  std::sort(wall.begin(), wall.end());
  std::sort(cpu.begin(), cpu.end());
  return {at_share(wall, 0.5), at_share(wall, 0.95), wall.back(), at_share(cpu, 0.5)};
}

std::uint32_t median_of(std::vector<std::uint32_t> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

Result<Screen> make_screen(const Surface& surface, const AtlasLayout& layout, const ScopeModel& scope,
                           const PaintBenchSettings& settings, PaintBy by, std::size_t most_triangles) {
  return Screen::create(surface, layout, scope,
                        {.width_px = kPanelWidth,
                         .height_px = kPanelHeight,
                         .seen_from = settings.seen_from,
                         .most_triangles = most_triangles,
                         .draw_by = by});
}

/// The ranges' triangles, all of them to be painted.
bool patch_of_ranges(Cutout& cutout, const ClusterTree& tree, const Pose<M, C>& X_MC, CutoutRanges& ranges,
                     CutoutPatch& patch) {
  cutout.ranges(X_MC, ranges);
  patch.X_MC = X_MC;
  patch.triangles.clear();
  patch.occluders.clear();
  for (std::uint32_t r = 0; r < ranges.count; ++r) {
    const auto ids = tree.triangle_ids().subspan(ranges.ranges[r].first, ranges.ranges[r].count);
    patch.triangles.insert(patch.triangles.end(), ids.begin(), ids.end());
  }
  patch.triangles_in_cone = ranges.triangles;
  return ranges.count > 0;
}

class Bench {
 public:
  Bench(const GlContext& context, Painter& painter, Screen& screen, Screen& full)
      : context_(context), painter_(painter), screen_(screen), full_(full) {
    for (std::size_t i = 0; i < kFrames; ++i) frames_.push_back(nv12_frame(i));
    panel_.resize(packed_bytes(PixelFormat::xrgb8888, kPanelWidth, kPanelHeight));
    state_.status.video = state_.status.tracker = Freshness::live;
  }

  void run(const CutoutPatch& patch, const Eye& eye, std::uint32_t unit, int frames) {
    state_.eye = eye;
    state_.X_MC = patch.X_MC;
    for (int settling = 0; settling < 16; ++settling) show(screen_);  // a coarse view becomes fine
    for (int i = 0; i < frames; ++i) {
      const Took step = new_frame(patch, unit) + show(screen_);
      if (i == 0) continue;  // the first of a capture keeps tiles for undo
      fixed_.push_back(step);
    }
    turn();
    moving_.push_back(new_frame(patch, unit) + show(screen_));
    turn();
    redraw_.push_back(new_frame(patch, unit) + show(full_));
    texels_.push_back(texels_of_step_);
    cutouts_.push_back(static_cast<std::uint32_t>(patch.triangles.size() + patch.occluders.size()));
  }

  /// The view's triangles in `patch`; false where there are none.
  template <class MapView>
  bool map(MapView&& view) {
    bool found = false;
    map_.push_back(time_of([&] { found = view(); }));
    return found;
  }

  void fill(PaintBenchReport& report) const {
    report.map = spread_of(map_);
    report.upload = spread_of(upload_);
    report.paint = spread_of(paint_);
    report.fixed_view = spread_of(fixed_);
    report.moving_view = spread_of(moving_);
    report.full_redraw = spread_of(redraw_);
    report.texels_median = median_of(texels_);
    report.cutout_triangles_median = median_of(cutouts_);
  }

 private:
  Took new_frame(const CutoutPatch& patch, std::uint32_t unit) {
    std::vector<std::byte>& frame = frames_[count_++ % kFrames];
    const Took upload = time_of([&] {
      painter_.upload(packed_image(frame.data(), PixelFormat::nv12, kWidth, kHeight));
      context_.finish();
    });
    const Took paint = time_of([&] {
      PaintReport report = painter_.paint(patch, unit);
      texels_of_step_ = report.texels;
      while (report.carried) {
        report = painter_.paint_more();
        texels_of_step_ += report.texels;
      }
      context_.finish();
    });
    upload_.push_back(upload);
    paint_.push_back(paint);
    ++state_.paint_version;
    return upload + paint;
  }

  Took show(Screen& screen) {
    return time_of([&] {
      screen.draw(state_, painter_,
                  packed_image(panel_.data(), PixelFormat::xrgb8888, kPanelWidth, kPanelHeight));
    });
  }

  void turn() { state_.eye.position_mm.x() += 1; }

  const GlContext& context_;
  Painter& painter_;
  Screen &screen_, &full_;
  std::vector<std::vector<std::byte>> frames_;
  std::vector<std::byte> panel_;
  ScreenState state_;
  std::size_t count_ = 0;
  std::uint32_t texels_of_step_ = 0;
  std::vector<Took> map_, upload_, paint_, fixed_, moving_, redraw_;
  std::vector<std::uint32_t> texels_, cutouts_;
};

}  // namespace

Result<PaintBenchReport> run_paint_bench(const Surface& surface, std::span<const Pose<M, C>> poses,
                                         const PaintBenchSettings& settings) {
  auto context = GlContext::create();
  if (!context) return tl::unexpected(context.error());
  if (auto current = context->make_current(); !current) return tl::unexpected(current.error());
  const ScopeModel scope = scope_for(settings);
  const auto layout = build_atlas(surface.mesh, {.texel_mm = settings.texel_mm});
  if (!layout) return tl::unexpected(layout.error());
  const MapperLimits limits{
      .max_triangles_per_step = static_cast<std::uint32_t>(surface.mesh.triangles.size()) + 48,
      .max_rays_per_step = 1U << 31};
  auto tree = ClusterTree::create(surface.mesh);
  if (!tree) return tl::unexpected(tree.error());
  auto rays = RayScene::create(surface.mesh);
  if (!rays) return tl::unexpected(rays.error());
  Cutout cutout(*tree, *rays, scope);
  CutoutRanges ranges(tree->cluster_count());
  auto mapper = Mapper::create(surface, settings.seen_from, scope, limits);
  if (!mapper) return tl::unexpected(mapper.error());
  const PaintBy by = settings.by.value_or(paint_by_for(context->render_class()));
  auto painter = Painter::create(surface, *layout, scope,
                                 {.seen_from = settings.seen_from,
                                  .policy = settings.policy,
                                  .highlights = Highlights::yield,
                                  .light = LightModel::auto_exposure,
                                  .paint_by = by});
  if (!painter) return tl::unexpected(painter.error());
  auto screen = make_screen(surface, *layout, scope, settings, by, ScreenSettings{}.most_triangles);
  if (!screen) return tl::unexpected(screen.error());
  auto full = make_screen(surface, *layout, scope, settings, by, surface.mesh.triangles.size());
  if (!full) return tl::unexpected(full.error());

  Bench bench(*context, *painter, *screen, *full);
  CutoutPatch patch(patch_capacity(limits));
  std::uint32_t unit = 0;
  for (const Pose<M, C>& X_MC : poses) {
    const bool found = bench.map([&] {
      if (settings.from == PaintFrom::ranges) return patch_of_ranges(cutout, *tree, X_MC, ranges, patch);
      mapper->begin(X_MC, TextureMode::perspective);
      return mapper->next(patch);
    });
    if (!found) continue;
    const Eigen::Vector3d back = -X_MC.rotation.col(2), up = -X_MC.rotation.col(1);
    bench.run(patch, eye_on(surface.mesh, back, up), ++unit, settings.frames_per_pose);
  }
  if (unit == 0)
    return fail("none of the " + std::to_string(poses.size()) +
                " poses sees the surface; check their space, or try the other --seen-from");
  PaintBenchReport report{.triangles = surface.mesh.triangles.size(),
                          .poses = unit,
                          .texel_mm = layout->texel_mm,
                          .atlas_size_texels = layout->width_texels,
                          .renderer = context->renderer_name()};
  bench.fill(report);
  return report;
}

std::string to_json(const PaintBenchReport& report) {
  const auto object = [](const char* name, const Spread& spread) {
    std::array<char, 256> text{};
    std::snprintf(
        text.data(), text.size(),
        "\"%s\": {\"median_ms\": %.3f, \"p95_ms\": %.3f, \"max_ms\": %.3f, \"cpu_median_ms\": %.3f}, ", name,
        spread.median_ms, spread.p95_ms, spread.max_ms, spread.cpu_median_ms);
    return std::string(text.data());
  };
  std::array<char, 256> head{};
  std::snprintf(head.data(), head.size(),
                "{\"triangles\": %zu, \"poses\": %zu, \"texel_mm\": %.4f, \"atlas_size_texels\": %d, "
                "\"cutout_triangles_median\": %u, \"texels_median\": %u, ",
                report.triangles, report.poses, report.texel_mm, report.atlas_size_texels,
                report.cutout_triangles_median, report.texels_median);
  return head.data() + object("map", report.map) + object("upload", report.upload) +
         object("paint", report.paint) + object("fixed_view", report.fixed_view) +
         object("moving_view", report.moving_view) + object("full_redraw", report.full_redraw) +
         "\"renderer\": \"" + report.renderer + "\"}";
}

}  // namespace orcart
