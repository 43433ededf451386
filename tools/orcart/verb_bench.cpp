// orcart bench: how long the mapper takes for a file of poses.
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "firmware-host/files/surface_file.hpp"
#include "tools/bench/mapper_bench.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart bench mapper --surface brain_50k.ply --poses poses200.csv --json\n\n"
    "Poses are lines of ten numbers: tip xyz, dir xyz, up xyz, distance_mm. Pin it to a core for steady "
    "times:\n"
    "  taskset -c 1 orcart bench mapper ...";

struct Arguments {
  std::string surface, poses;
  BenchCone cone;
  SeenFrom seen_from = SeenFrom::outside;
  TextureMode mode = TextureMode::perspective;
  std::uint32_t rounds = 50;
  bool without_occlusion = false, json = false;
};

Result<MapperBenchReport> bench(const Arguments& arguments) {
  const auto surface = read_surface(arguments.surface, nullptr, Space::lps);
  if (!surface) return tl::unexpected(surface.error());
  const auto poses = read_bench_poses(arguments.poses);
  if (!poses) return tl::unexpected(poses.error());
  const MapperLimits limits{.test_occlusion = !arguments.without_occlusion};
  auto mapper = Mapper::create(*surface, arguments.seen_from, bench_scope(arguments.cone), limits);
  if (!mapper) return tl::unexpected(mapper.error());
  CutoutPatch patch(patch_capacity(limits));
  return run_mapper_bench(*mapper, patch, *poses, arguments.rounds, arguments.mode);
}

void print(const MapperBenchReport& report) {
  std::printf("a view: median %.1f us, p99 %.1f us, max %.1f us; worst pose's median %.1f us\n",
              report.median_us, report.p99_us, report.max_us, report.worst_pose_median_us);
  std::printf("triangles in the cone: median %u, max %u; steps a view: at most %u, p99 %.1f us\n",
              report.triangles_median, report.triangles_max, report.steps_max, report.step_p99_us);
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
  mapper->add_option("--surface", arguments->surface, "PLY, STL or OBJ; LPS mm where it states no space")
      ->required();
  mapper->add_option("--poses", arguments->poses, "bench poses, CSV")->required();
  mapper->add_option("--cone", arguments->cone.half_angle_deg, "half angle of the viewing cone, degrees")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 85.0));
  mapper->add_option("--far", arguments->cone.far_mm, "far plane, mm")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  mapper->add_option("--seen-from", arguments->seen_from, "outside (default) or inside")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, SeenFrom>{{"outside", SeenFrom::outside}, {"inside", SeenFrom::inside}}));
  mapper->add_option("--mode", arguments->mode, "perspective (default) or paper")
      ->transform(CLI::CheckedTransformer(std::map<std::string, TextureMode>{
          {"perspective", TextureMode::perspective}, {"paper", TextureMode::paper}}));
  mapper->add_option("--rounds", arguments->rounds, "how often all poses are run")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  mapper->add_flag("--no-occlusion", arguments->without_occlusion, "leave what is hidden to the painter");
  mapper->add_flag("--json", arguments->json, "one JSON object");
  mapper->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace orcart
