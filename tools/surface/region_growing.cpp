// A flood in the order of how far an intensity lies from the seeds': one bucket of voxels a step.
#include "tools/surface/region_growing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace orcart {

namespace {

std::string shown(const PlainPoint& point) {
  std::ostringstream out;
  out << "(" << point[0] << ", " << point[1] << ", " << point[2] << ")";
  return out.str();
}

/// The box of the volume in LPS: where a seed may lie.
std::string box_of(const VoxelLattice& lattice) {
  PlainPoint low = lattice.origin_mm, high = low;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<double, 3> index{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      index[axis] = (corner >> axis & 1U) != 0 ? lattice.size[axis] - 1 : 0;
    const PlainPoint place = place_of(lattice, index);
    for (std::size_t row = 0; row < 3; ++row) {
      low[row] = std::min(low[row], place[row]);
      high[row] = std::max(high[row], place[row]);
    }
  }
  return "x " + std::to_string(std::lround(low[0])) + ".." + std::to_string(std::lround(high[0])) + ", y " +
         std::to_string(std::lround(low[1])) + ".." + std::to_string(std::lround(high[1])) + ", z " +
         std::to_string(std::lround(low[2])) + ".." + std::to_string(std::lround(high[2])) + " mm";
}

class Flood {
 public:
  Flood(const Volume& volume, const RegionGrowing& options, const std::string& name)
      : volume_(volume), options_(options), name_(name) {
    const auto& size = volume.lattice.size;
    for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = static_cast<std::uint32_t>(size[axis]);
    stride_ = {1, size_[0], size_[0] * size_[1]};
  }

  Result<void> take_seeds() {
    for (const PlainPoint& seed : options_.seeds_mm) {
      const auto at = index_of(seed);
      if (!at) return tl::unexpected(at.error());
      seeds_.push_back(*at);
    }
    low_seed_ = high_seed_ = volume_.values[seeds_.front()];
    for (const std::uint32_t seed : seeds_) {
      low_seed_ = std::min(low_seed_, volume_.values[seed]);
      high_seed_ = std::max(high_seed_, volume_.values[seed]);
    }
    return {};
  }

  std::vector<std::uint8_t> run(std::vector<std::size_t>& counts) {
    inside_.assign(volume_.values.size(), 0);
    for (const std::uint32_t seed : seeds_) reach(seed, 0);
    std::size_t count = 0;
    for (int step = 0; step <= GrowthCurve::kSteps; ++step) {
      auto& bucket = buckets_[static_cast<std::size_t>(step)];
      while (!bucket.empty()) {
        const std::uint32_t at = bucket.back();
        bucket.pop_back();
        ++count;
        spread(at, step);
      }
      bucket = {};
      counts.push_back(count);
    }
    return std::move(inside_);
  }

 private:
  Result<std::uint32_t> index_of(const PlainPoint& seed_mm) const {
    const auto index = index_at(volume_.lattice, seed_mm);
    std::uint32_t at = 0;
    const std::string seed = name_ + ": the seed " + shown(seed_mm) + " mm (LPS)";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(index[axis] > -0.5 && index[axis] < size_[axis] - 0.5))
        return fail(seed + " lies outside the volume, which spans " + box_of(volume_.lattice) +
                    " LPS; a seed inside the region is expected (--seed-space RAS where it is given so)");
      at += stride_[axis] * static_cast<std::uint32_t>(std::lround(index[axis]));
    }
    const double intensity = static_cast<double>(volume_.values[at]);
    if (intensity >= options_.lowest && intensity <= options_.highest) return at;
    const auto [low, high] = std::minmax_element(volume_.values.begin(), volume_.values.end());
    std::ostringstream out;
    out << seed << " has the intensity " << intensity << "; one from " << options_.lowest << " to "
        << options_.highest << " is expected (the volume holds " << *low << " to " << *high << ")";
    return fail(out.str());
  }

  /// In which step a voxel may join; beyond kSteps: never.
  int step_of(float intensity) const {
    const double value = static_cast<double>(intensity);
    if (!(value >= options_.lowest && value <= options_.highest)) return GrowthCurve::kSteps + 1;
    if (intensity > high_seed_)
      return static_cast<int>(std::ceil(GrowthCurve::kSteps * (value - static_cast<double>(high_seed_)) /
                                        (options_.highest - static_cast<double>(high_seed_))));
    if (intensity < low_seed_)
      return static_cast<int>(std::ceil(GrowthCurve::kSteps * (static_cast<double>(low_seed_) - value) /
                                        (static_cast<double>(low_seed_) - options_.lowest)));
    return 0;
  }

  void reach(std::uint32_t at, int step) {
    if (inside_[at] != 0) return;
    const int own = step_of(volume_.values[at]);
    if (own > GrowthCurve::kSteps) return;
    inside_[at] = 1;
    buckets_[static_cast<std::size_t>(std::max(step, own))].push_back(at);
  }

  void spread(std::uint32_t at, int step) {
    const std::array<std::uint32_t, 3> index{at % size_[0], at / stride_[1] % size_[1], at / stride_[2]};
    for (std::size_t axis = 3; axis-- > 0;) {
      if (index[axis] > 0) reach(at - stride_[axis], step);
      if (index[axis] + 1 < size_[axis]) reach(at + stride_[axis], step);
    }
  }

  const Volume& volume_;
  const RegionGrowing& options_;
  const std::string& name_;
  std::array<std::uint32_t, 3> size_{}, stride_{};
  std::vector<std::uint32_t> seeds_;
  float low_seed_ = 0, high_seed_ = 0;
  std::vector<std::uint8_t> inside_;
  std::array<std::vector<std::uint32_t>, GrowthCurve::kSteps + 1> buckets_;
};

std::string leak_sentence(const GrownRegion& region, const RegionGrowing& options) {
  const auto& curve = region.curve;
  char text[480];
  const auto step = static_cast<std::size_t>(curve.jump_at);
  const double part = curve.jump_at / static_cast<double>(GrowthCurve::kSteps);
  std::snprintf(
      text, sizeof text,
      "the region grown from %g to %g leaks: it jumps from %.1f to %.1f ml where the range passes "
      "%.0f %% of the way from the seeds' intensity to its ends; a narrower --range (a lower HI for "
      "dark fluid, a higher LO for bone) is expected, or --accept-leak where that is the region",
      options.lowest, options.highest, curve.volume_ml[step - 1], curve.volume_ml[step], 100 * part);
  return text;
}

Result<void> check_for_leak(const GrownRegion& region, const RegionGrowing& options,
                            const std::string& name) {
  if (options.largest_ml > 0 && region.volume_ml > options.largest_ml) {
    std::ostringstream out;
    out << name << ": the region grown from " << options.lowest << " to " << options.highest << " fills "
        << std::lround(region.volume_ml)
        << " ml, so it leaked; a narrower --range (a lower HI for dark fluid), or a --max-volume over the "
        << options.largest_ml << " ml that are accepted, is expected";
    return fail(out.str());
  }
  if (region.curve.jump_at > 0 && options.leak == LeakPolicy::refuse)
    return fail(name + ": " + leak_sentence(region, options));
  return {};
}

}  // namespace

int leak_step(const std::vector<double>& volume_ml) {
  constexpr double kLeastMl = 0.5, kJump = 2;
  int worst = 0;
  double worst_factor = kJump;
  for (int step = GrowthCurve::kSteps / 4; step <= GrowthCurve::kSteps; ++step) {
    const double before = volume_ml[static_cast<std::size_t>(step) - 1],
                 after = volume_ml[static_cast<std::size_t>(step)];
    if (before < kLeastMl || after < worst_factor * before) continue;
    worst = step;
    worst_factor = after / before;
  }
  return worst;
}

Result<GrownRegion> grow_region(const Volume& volume, const RegionGrowing& options, const std::string& name) {
  Flood flood(volume, options, name);
  if (auto taken = flood.take_seeds(); !taken) return tl::unexpected(taken.error());
  std::vector<std::size_t> counts;
  GrownRegion region;
  region.voxels = flood.run(counts);
  const double voxel_ml = std::abs(voxel_mm3(volume.lattice)) / 1000;
  for (const std::size_t count : counts)
    region.curve.volume_ml.push_back(static_cast<double>(count) * voxel_ml);
  region.curve.jump_at = leak_step(region.curve.volume_ml);
  region.count = count_voxels({.size = volume.lattice.size, .voxels = region.voxels});
  region.volume_ml = region.curve.volume_ml.back();
  if (auto sound = check_for_leak(region, options, name); !sound) return tl::unexpected(sound.error());
  if (region.curve.jump_at > 0) region.notes.push_back(leak_sentence(region, options));
  if (region.count.touches_border)
    region.notes.push_back(
        "the region reaches the border of the volume, so it leaked or the anatomy goes on beyond; the "
        "surface "
        "is closed flat there");
  return region;
}

}  // namespace orcart
