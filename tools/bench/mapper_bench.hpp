// Times the mapper pose by pose: what `orcart bench mapper` prints and the budget tests read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/mapper/cutout.hpp"
#include "realtime/mapper/mapper.hpp"

namespace orcart {

/// Bench poses: a line `tip xyz, dir xyz, up xyz, distance_mm` each, comma separated, `#` starts a comment
/// line. C's z is dir, -y is up. Refuses a line that does not hold ten numbers, and dir and up that are not
/// unit and square to each other within 0.01; what is left of that is taken out.
Result<std::vector<Pose<M, C>>> read_bench_poses(const std::filesystem::path& file);

/// The scope of the bench: a viewing cone, and a pinhole with its mask at the cone's edge for the five rays.
struct BenchCone {
  double half_angle_deg = 35;
  double far_mm = 60;
};
ScopeModel bench_scope(const BenchCone& cone);

/// What is timed.
enum class BenchForm {
  cutout,  ///< Cutout: five rays, whole triangles with texture coordinates
  clip,    ///< the same, cut by the cone
  ranges,  ///< Cutout: cluster ranges alone
  live,    ///< Mapper, as the cart runs it: five rays, facing, and hiding unless told
};

struct MapperBenchReport {
  double median_us = 0, p99_us = 0, max_us = 0;  ///< over all poses and rounds, begin() and every next()
  double worst_pose_median_us = 0;               ///< the largest of the poses' medians over the rounds
  std::uint32_t triangles_median = 0, triangles_max = 0;      ///< handed out, per pose
  std::uint32_t with_corner_median = 0, with_corner_max = 0;  ///< forms cutout and clip: of the surface's
                                                              ///< triangles, those with a corner in the cone
  std::uint32_t steps_max = 0;                                ///< that a view took
  double step_p99_us = 0;  ///< of each view's longest step: what the mapper's budget holds against
  double tree_bytes_per_triangle = 0;         ///< Embree's apart
  std::optional<double> occlusion_median_us;  ///< form live: what hiding adds to a view's median
  std::optional<std::uint64_t>
      heap_calls;  ///< of all timed views together; nothing where they cannot be counted
};

struct BenchSettings {
  BenchForm form = BenchForm::cutout;
  CutoutRule rule = CutoutRule::touching;       ///< forms cutout and clip
  SeenFrom seen_from = SeenFrom::outside;       ///< form live
  TextureMode mode = TextureMode::perspective;  ///< form live
  MapperLimits limits;                          ///< form live; max_triangles_per_step for all
  std::uint32_t rounds = 50;
};

/// Runs all poses `rounds` times after one round that warms up. Refuses what Mapper::create() refuses, and no
/// poses.
Result<MapperBenchReport> run_mapper_bench(const Surface& surface, const ScopeModel& scope,
                                           std::span<const Pose<M, C>> poses, const BenchSettings& settings);

/// Keeps this thread on the processor it runs on, so that times compare; says whether the system let it.
bool pin_this_thread() noexcept;

/// One JSON object, one line.
std::string to_json(const MapperBenchReport& report);

}  // namespace orcart
