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
  std::uint32_t triangles = 0, parts = 0;
};

ViewCost run_view(Mapper& mapper, CutoutPatch& patch, const Pose<M, C>& X_MC, TextureMode mode) {
  ViewCost cost;
  const auto start = std::chrono::steady_clock::now();
  mapper.begin(X_MC, mode);
  for (double step_start_us = 0; mapper.next(patch); step_start_us = cost.us) {
    cost.us = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    cost.longest_step_us = std::max(cost.longest_step_us, cost.us - step_start_us);
    cost.triangles += patch.triangles_in_cone;
    ++cost.parts;
  }
  return cost;
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

MapperBenchReport run_mapper_bench(Mapper& mapper, CutoutPatch& patch, std::span<const Pose<M, C>> poses,
                                   std::uint32_t rounds, TextureMode mode) {
  std::vector<std::vector<double>> us_of_pose(poses.size());
  std::vector<double> longest_steps_us;
  longest_steps_us.reserve(poses.size() * rounds);
  for (auto& samples : us_of_pose) samples.reserve(rounds);
  std::vector<std::uint32_t> triangles;
  MapperBenchReport report;
  for (const auto& X_MC : poses) {
    const ViewCost cost = run_view(mapper, patch, X_MC, mode);
    triangles.push_back(cost.triangles);
    report.steps_max = std::max(report.steps_max, cost.parts);
  }
  const auto before = heap_calls_of_this_thread();
  for (std::uint32_t round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const ViewCost cost = run_view(mapper, patch, poses[i], mode);
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
  return report;
}

std::string to_json(const MapperBenchReport& report) {
  std::array<char, 512> text{};
  const std::string heap = report.heap_calls ? std::to_string(*report.heap_calls) : "null";
  std::snprintf(text.data(), text.size(),
                "{\"median_us\": %.2f, \"p99_us\": %.2f, \"max_us\": %.2f, \"worst_pose_median_us\": %.2f, "
                "\"triangles_median\": %u, \"triangles_max\": %u, \"steps_max\": %u, \"step_p99_us\": %.2f, "
                "\"heap_calls\": %s}",
                report.median_us, report.p99_us, report.max_us, report.worst_pose_median_us,
                report.triangles_median, report.triangles_max, report.steps_max, report.step_p99_us,
                heap.c_str());
  return text.data();
}

}  // namespace orcart
