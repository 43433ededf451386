// orcart bench paint: how long painting and the panel's picture take for a file of poses.
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include "firmware-host/files/surface_file.hpp"
#include "tools/bench/mapper_bench.hpp"
#include "tools/bench/paint/paint_bench.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart bench paint --surface brain_50k.ply --poses poses200.csv --every 10 --json\n\n"
    "Poses are lines of ten numbers: tip xyz, dir xyz, up xyz, distance_mm. Each pose gets new frames of\n"
    "1920x1080 NV12 and a panel of 1280x800.";

struct Arguments {
  std::string surface, poses;
  double cone_deg = 35;
  std::size_t every = 1;
  PaintBenchSettings settings;
  bool json = false;
};

Result<PaintBenchReport> bench(const Arguments& arguments) {
  const auto surface = read_surface(arguments.surface, nullptr, Space::lps);
  if (!surface) return tl::unexpected(surface.error());
  const auto all = read_bench_poses(arguments.poses);
  if (!all) return tl::unexpected(all.error());
  std::vector<Pose<M, C>> poses;
  for (std::size_t i = 0; i < all->size(); i += arguments.every) poses.push_back((*all)[i]);
  return run_paint_bench(*surface, poses, arguments.settings);
}

void print(const PaintBenchReport& report) {
  std::printf("%zu triangles, %zu poses, texels of %.3g mm in %dx%d, %s\n", report.triangles, report.poses,
              report.texel_mm, report.atlas_size_texels, report.atlas_size_texels, report.renderer.c_str());
  std::printf("a view: %u triangles paint or hide, %u texels\n", report.cutout_triangles_median,
              report.texels_median);
  const auto line = [](const char* name, const Spread& spread) {
    std::printf("%-28s median %6.2f ms, p95 %6.2f ms, max %6.2f ms; of processor time %6.2f ms\n", name,
                spread.median_ms, spread.p95_ms, spread.max_ms, spread.cpu_median_ms);
  };
  line("cutout", report.map);
  line("upload", report.upload);
  line("paint", report.paint);
  line("new frame, fixed view", report.fixed_view);
  line("new frame, moving view", report.moving_view);
  line("new frame, full redraw", report.full_redraw);
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

void add_bench_paint(CLI::App& bench_verb, int& exit_code) {
  auto* paint = bench_verb.add_subcommand("paint", "Time painting and the panel's picture, pose by pose");
  paint->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  paint->add_option("--surface", arguments->surface, "PLY, STL, OBJ or mz3; LPS mm where it states no space")
      ->required();
  paint->add_option("--poses", arguments->poses, "bench poses, CSV")->required();
  paint->add_option("--every", arguments->every, "take only every n-th pose")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
  paint->add_option("--cone", arguments->cone_deg, "half angle of the viewing cone, degrees")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 75.0));
  paint->add_option("--far", arguments->settings.far_mm, "far plane, mm")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  paint->add_option("--texel-mm", arguments->settings.texel_mm, "size of the paint's texels")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 10.0));
  paint->add_option("--seen-from", arguments->settings.seen_from, "outside (default) or inside")
      ->transform(one_of<SeenFrom>({{"outside", SeenFrom::outside}, {"inside", SeenFrom::inside}}));
  paint->add_option("--policy", arguments->settings.policy, "newest (default) or best")
      ->transform(one_of<PaintPolicy>({{"newest", PaintPolicy::newest}, {"best", PaintPolicy::best}}));
  paint->add_option("--from", arguments->settings.from, "lists (default): the cart's; ranges: whole clusters")
      ->transform(one_of<PaintFrom>({{"lists", PaintFrom::lists}, {"ranges", PaintFrom::ranges}}));
  paint
      ->add_option("--by", arguments->settings.by,
                   "gpu or processor; unless told otherwise whoever suits the driver")
      ->transform(one_of<PaintBy>({{"gpu", PaintBy::gpu}, {"processor", PaintBy::processor}}));
  paint->add_flag("--json", arguments->json, "one JSON object");
  paint->callback([arguments, &exit_code] {
    arguments->settings.cone_half_angle_rad = arguments->cone_deg * std::numbers::pi / 180;
    exit_code = run(*arguments);
  });
}

}  // namespace orcart
