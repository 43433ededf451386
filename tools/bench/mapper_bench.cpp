// Reads poses, runs them round after round, and sums the times up.
#include "tools/bench/mapper_bench.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include <sched.h>

#include <Eigen/Geometry>

#include "tools/bench/heap_calls.hpp"

namespace orcart {
namespace {

constexpr double kLargestDeviation = 0.01;

/// Ten numbers with commas between them and nothing else.
std::optional<std::array<double, 10>> ten_numbers(const std::string& line) {
  std::array<double, 10> numbers{};
  std::istringstream in(line);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (in >> std::ws).get() != ',') return std::nullopt;
    if (!(in >> numbers[i])) return std::nullopt;
  }
  return (in >> std::ws).eof() ? std::optional(numbers) : std::nullopt;
}

std::optional<Pose<M, C>> pose_of(const std::array<double, 10>& n) {
  const Eigen::Vector3d z(n[3], n[4], n[5]), up(n[6], n[7], n[8]);
  Eigen::Matrix3d axes;
  axes << z.cross(up), -up, z;
  const NearestRotation nearest = nearest_rotation(axes);
  if (nearest.deviation > kLargestDeviation || nearest.reflected) return std::nullopt;
  return Pose<M, C>{.rotation = nearest.rotation, .translation_mm = {n[0], n[1], n[2]}};
}

/// The value below which `fraction` of the samples lie; reorders them.
template <class T>
T quantile(std::vector<T>& samples, double fraction) {
  const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(samples.size() - 1) + 0.5);
  std::nth_element(samples.begin(), samples.begin() + rank, samples.end());
  return samples[static_cast<std::size_t>(rank)];
}

struct ViewCost {
  double us = 0, longest_step_us = 0;
  std::uint32_t triangles = 0, with_corner = 0, parts = 0;
};

class StopWatch {
 public:
  /// Microseconds since it was made.
  double us() const {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One form's view from begin() to its last part.
class TimedView {
 public:
  TimedView() = default;
  TimedView(const TimedView&) = delete;
  TimedView& operator=(const TimedView&) = delete;
  virtual ~TimedView() = default;
  virtual ViewCost run(const Pose<M, C>& X_MC) = 0;
};

class LiveView : public TimedView {
 public:
  LiveView(Mapper mapper, const MapperLimits& limits, TextureMode mode)
      : mapper_(std::move(mapper)), patch_(patch_capacity(limits)), mode_(mode) {}
  ViewCost run(const Pose<M, C>& X_MC) override {
    ViewCost cost;
    const StopWatch watch;
    mapper_.begin(X_MC, mode_);
    for (double step_start_us = 0; mapper_.next(patch_); step_start_us = cost.us) {
      cost.us = watch.us();
      cost.longest_step_us = std::max(cost.longest_step_us, cost.us - step_start_us);
      cost.triangles += patch_.triangles_in_cone;
      ++cost.parts;
    }
    return cost;
  }

 private:
  Mapper mapper_;
  CutoutPatch patch_;
  TextureMode mode_;
};

class CutoutView : public TimedView {
 public:
  CutoutView(Cutout cutout, std::size_t max_triangles, CutoutForm form)
      : cutout_(cutout), mesh_(max_triangles), form_(form) {}
  ViewCost run(const Pose<M, C>& X_MC) override {
    ViewCost cost;
    const StopWatch watch;
    cutout_.begin(X_MC, form_);
    for (double step_start_us = 0; cutout_.next(mesh_); step_start_us = cost.us) {
      cost.us = watch.us();
      cost.longest_step_us = std::max(cost.longest_step_us, cost.us - step_start_us);
      cost.triangles += mesh_.triangles;
      cost.with_corner += mesh_.with_corner;
      ++cost.parts;
    }
    return cost;
  }

 private:
  Cutout cutout_;
  CutoutMesh mesh_;
  CutoutForm form_;
};

class RangesView : public TimedView {
 public:
  RangesView(Cutout cutout, std::size_t clusters) : cutout_(cutout), ranges_(clusters) {}
  ViewCost run(const Pose<M, C>& X_MC) override {
    const StopWatch watch;
    cutout_.ranges(X_MC, ranges_);
    const double us = watch.us();
    return {.us = us, .longest_step_us = us, .triangles = ranges_.triangles, .parts = 1};
  }

 private:
  Cutout cutout_;
  CutoutRanges ranges_;
};

MapperBenchReport time_views(TimedView& view, std::span<const Pose<M, C>> poses, std::uint32_t rounds) {
  std::vector<std::vector<double>> us_of_pose(poses.size());
  std::vector<double> longest_steps_us;
  longest_steps_us.reserve(poses.size() * rounds);
  for (auto& samples : us_of_pose) samples.reserve(rounds);
  std::vector<std::uint32_t> triangles, with_corner;
  MapperBenchReport report;
  for (const auto& X_MC : poses) {
    const ViewCost cost = view.run(X_MC);
    triangles.push_back(cost.triangles);
    with_corner.push_back(cost.with_corner);
    report.steps_max = std::max(report.steps_max, cost.parts);
  }
  const auto before = heap_calls_of_this_thread();
  for (std::uint32_t round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const ViewCost cost = view.run(poses[i]);
      us_of_pose[i].push_back(cost.us);
      longest_steps_us.push_back(cost.longest_step_us);
    }
  if (const auto after = heap_calls_of_this_thread()) report.heap_calls = *after - *before;

  std::vector<double> all;
  for (auto& samples : us_of_pose) {
    all.insert(all.end(), samples.begin(), samples.end());
    report.worst_pose_median_us = std::max(report.worst_pose_median_us, quantile(samples, 0.5));
  }
  report.median_us = quantile(all, 0.5);
  report.p99_us = quantile(all, 0.99);
  report.max_us = *std::max_element(all.begin(), all.end());
  report.step_p99_us = quantile(longest_steps_us, 0.99);
  report.triangles_max = *std::max_element(triangles.begin(), triangles.end());
  report.triangles_median = quantile(triangles, 0.5);
  report.with_corner_max = *std::max_element(with_corner.begin(), with_corner.end());
  report.with_corner_median = quantile(with_corner, 0.5);
  return report;
}

/// Form live: with and without hiding in one run, so that the difference is hiding's.
Result<MapperBenchReport> bench_live(const Surface& surface, const ScopeModel& scope,
                                     std::span<const Pose<M, C>> poses, const BenchSettings& settings) {
  const auto timed = [&](const MapperLimits& limits) -> Result<MapperBenchReport> {
    auto mapper = Mapper::create(surface, settings.seen_from, scope, limits);
    if (!mapper) return tl::unexpected(mapper.error());
    LiveView view(std::move(*mapper), limits, settings.mode);
    return time_views(view, poses, settings.rounds);
  };
  auto report = timed(settings.limits);
  if (!report || !settings.limits.test_occlusion || settings.mode == TextureMode::paper) return report;
  MapperLimits without = settings.limits;
  without.test_occlusion = false;
  const auto bare = timed(without);
  if (!bare) return bare;
  report->occlusion_median_us = report->median_us - bare->median_us;
  return report;
}

}  // namespace

Result<std::vector<Pose<M, C>>> read_bench_poses(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) return fail(file.string() + ": cannot be opened; give a file of bench poses");
  std::vector<Pose<M, C>> poses;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line[0] == '#') continue;
    const auto numbers = ten_numbers(line);
    const auto pose = numbers ? pose_of(*numbers) : std::nullopt;
    if (!pose)
      return fail(file.string() + ":" + std::to_string(number) +
                  ": wants ten numbers `tip xyz, dir xyz, up xyz, distance_mm` with commas between, dir and "
                  "up of unit "
                  "length and square to each other");
    poses.push_back(*pose);
  }
  if (poses.empty()) return fail(file.string() + ": holds no pose; one line of ten numbers is the least");
  return poses;
}

ScopeModel bench_scope(const BenchCone& cone) {
  ScopeModel scope;
  scope.name = "bench";
  scope.width_px = scope.height_px = 640;
  scope.cone_half_angle_rad = cone.half_angle_deg * std::numbers::pi / 180;
  scope.far_mm = cone.far_mm;
  const double focal_px = 320 / std::tan(scope.cone_half_angle_rad);
  scope.lens = {.fx_px = focal_px, .fy_px = focal_px, .cx_px = 319.5, .cy_px = 319.5};
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.5);
  scope.mask = {.cx_px = 319.5, .cy_px = 319.5, .radius_px = 320};
  return scope;
}

Result<MapperBenchReport> run_mapper_bench(const Surface& surface, const ScopeModel& scope,
                                           std::span<const Pose<M, C>> poses, const BenchSettings& settings) {
  if (poses.empty()) return fail("the bench has no poses; one is the least");
  const auto tree = ClusterTree::create(surface.mesh);
  if (!tree) return tl::unexpected(tree.error());
  Result<MapperBenchReport> report;
  if (settings.form == BenchForm::live) {
    report = bench_live(surface, scope, poses, settings);
  } else {
    const auto rays = RayScene::create(surface.mesh);
    if (!rays) return tl::unexpected(rays.error());
    const Cutout cutout(*tree, *rays, scope, settings.rule);
    if (settings.form == BenchForm::ranges) {
      RangesView view(cutout, tree->cluster_count());
      report = time_views(view, poses, settings.rounds);
    } else {
      CutoutView view(cutout, settings.limits.max_triangles_per_step,
                      settings.form == BenchForm::clip ? CutoutForm::clip : CutoutForm::whole);
      report = time_views(view, poses, settings.rounds);
    }
  }
  if (report)
    report->tree_bytes_per_triangle =
        static_cast<double>(tree->bytes()) / static_cast<double>(tree->triangle_count());
  return report;
}

bool pin_this_thread() noexcept {
  const int processor = sched_getcpu();
  if (processor < 0) return false;
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(static_cast<std::size_t>(processor), &only);
  return sched_setaffinity(0, sizeof(only), &only) == 0;
}

std::string to_json(const MapperBenchReport& report) {
  std::array<char, 1024> text{};
  const std::string heap = report.heap_calls ? std::to_string(*report.heap_calls) : "null";
  const std::string occlusion =
      report.occlusion_median_us ? std::to_string(*report.occlusion_median_us) : "null";
  std::snprintf(text.data(), text.size(),
                "{\"median_us\": %.3f, \"p99_us\": %.3f, \"max_us\": %.3f, \"worst_pose_median_us\": %.3f, "
                "\"triangles_median\": %u, \"triangles_max\": %u, \"with_corner_median\": %u, "
                "\"with_corner_max\": %u, \"steps_max\": %u, \"step_p99_us\": %.3f, "
                "\"occlusion_median_us\": %s, \"tree_bytes_per_triangle\": %.2f, \"heap_calls\": %s}",
                report.median_us, report.p99_us, report.max_us, report.worst_pose_median_us,
                report.triangles_median, report.triangles_max, report.with_corner_median,
                report.with_corner_max, report.steps_max, report.step_p99_us, occlusion.c_str(),
                report.tree_bytes_per_triangle, heap.c_str());
  return text.data();
}

}  // namespace orcart
