// orcart bench: how long the mapper takes for a file of poses.
#include <cstdio>
#include <memory>
#include <string>

#include "firmware-host/files/surface_file.hpp"
#include "tools/bench/mapper_bench.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart bench mapper --surface brain_50k.ply --poses poses200.csv --form cutout --json\n\n"
    "Poses are lines of ten numbers: tip xyz, dir xyz, up xyz, distance_mm. It stays on one processor; "
    "`taskset -c 1` before it\nchooses which. Forms: cutout (five rays, whole triangles with texture "
    "coordinates), clip (cut by the cone), ranges\n(clusters to draw; the shader projects), live (the cart's "
    "mapper with facing and hiding).";

struct Arguments {
  std::string surface, poses;
  BenchCone cone;
  BenchSettings settings;
  bool without_occlusion = false, json = false;
};

Result<MapperBenchReport> bench(const Arguments& arguments) {
  const auto surface = read_surface(arguments.surface, nullptr, Space::lps);
  if (!surface) return tl::unexpected(surface.error());
  const auto poses = read_bench_poses(arguments.poses);
  if (!poses) return tl::unexpected(poses.error());
  BenchSettings settings = arguments.settings;
  settings.limits.test_occlusion = !arguments.without_occlusion;
  pin_this_thread();
  return run_mapper_bench(*surface, bench_scope(arguments.cone), *poses, settings);
}

void print(const MapperBenchReport& report) {
  std::printf("a view: median %.2f us, p99 %.2f us, max %.1f us; worst pose's median %.2f us\n",
              report.median_us, report.p99_us, report.max_us, report.worst_pose_median_us);
  std::printf("triangles: median %u, max %u; steps a view: at most %u, p99 %.2f us\n",
              report.triangles_median, report.triangles_max, report.steps_max, report.step_p99_us);
  if (report.occlusion_median_us) std::printf("of it hiding: %.1f us\n", *report.occlusion_median_us);
  std::printf("the tree: %.1f bytes a triangle\n", report.tree_bytes_per_triangle);
  if (report.heap_calls)
    std::printf("heap calls: %llu\n", static_cast<unsigned long long>(*report.heap_calls));
}

int run(const Arguments& arguments) {
  const auto report = bench(arguments);
  if (!report) {
    std::fprintf(stderr, "orcart bench: %s\n", report.error().message.c_str());
    return 1;
  }
  if (arguments.json)
    std::printf("%s\n", to_json(*report).c_str());
  else
    print(*report);
  return 0;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  auto* bench = app.add_subcommand("bench", "Measure a part of the cart on this machine");
  bench->require_subcommand(1);
  auto* mapper = bench->add_subcommand("mapper", "Time the mapper's view, pose by pose");
  mapper->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  mapper->add_option("--surface", arguments->surface, "PLY, STL, OBJ or mz3; LPS mm where it states no space")
      ->required();
  mapper->add_option("--poses", arguments->poses, "bench poses, CSV")->required();
  mapper->add_option("--cone", arguments->cone.half_angle_deg, "half angle of the viewing cone, degrees")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 85.0));
  mapper->add_option("--far", arguments->cone.far_mm, "far plane, mm")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  BenchSettings& settings = arguments->settings;
  mapper->add_option("--form", settings.form, "cutout (default), clip, ranges or live")
      ->transform(one_of<BenchForm>({{"cutout", BenchForm::cutout},
                                     {"clip", BenchForm::clip},
                                     {"ranges", BenchForm::ranges},
                                     {"live", BenchForm::live}}));
  mapper
      ->add_option("--rule", settings.rule,
                   "of cutout and clip: touching (default, every triangle that meets the cone) or corner "
                   "(those with a corner in it)")
      ->transform(one_of<CutoutRule>({{"touching", CutoutRule::touching}, {"corner", CutoutRule::corner}}));
  mapper->add_option("--seen-from", settings.seen_from, "of live: outside (default) or inside")
      ->transform(one_of<SeenFrom>({{"outside", SeenFrom::outside}, {"inside", SeenFrom::inside}}));
  mapper->add_option("--mode", settings.mode, "of live: perspective (default) or paper")
      ->transform(
          one_of<TextureMode>({{"perspective", TextureMode::perspective}, {"paper", TextureMode::paper}}));
  mapper->add_option("--rounds", settings.rounds, "how often all poses are run")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  mapper->add_flag("--no-occlusion", arguments->without_occlusion,
                   "of live: leave what is hidden to the painter");
  mapper->add_flag("--json", arguments->json, "one JSON object");
  mapper->callback([arguments, &exit_code] { exit_code = run(*arguments); });
  add_bench_paint(*bench, exit_code);
}

}  // namespace orcart
