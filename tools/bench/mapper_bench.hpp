// Times the mapper pose by pose: what `orcart bench mapper` prints and the budget tests read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
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

struct MapperBenchReport {
  double median_us = 0, p99_us = 0, max_us = 0;  ///< over all poses and rounds, begin() and every next()
  double worst_pose_median_us = 0;               ///< the largest of the poses' medians over the rounds
  std::uint32_t triangles_median = 0, triangles_max = 0;  ///< in the cone, per pose
  std::uint32_t steps_max = 0;                            ///< that a view took
  double step_p99_us = 0;  ///< of each view's longest step: what the mapper's budget holds against
  std::optional<std::uint64_t>
      heap_calls;  ///< of all timed views together; nothing where they cannot be counted
};

/// Runs all poses `rounds` times after one round that warms up. Poses may not be empty.
MapperBenchReport run_mapper_bench(Mapper& mapper, CutoutPatch& patch, std::span<const Pose<M, C>> poses,
                                   std::uint32_t rounds, TextureMode mode);

/// One JSON object, one line.
std::string to_json(const MapperBenchReport& report);

}  // namespace orcart
