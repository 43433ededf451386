// Times painting and showing pose by pose: what `orcart bench paint` prints.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/mapper.hpp"
#include "render/atlas/paint_settings.hpp"

namespace orcart {

/// What the painter is given.
enum class PaintFrom : std::uint8_t {
  lists,   ///< the mapper's, as in the cart: to paint, and what only hides
  ranges,  ///< every triangle of the clusters that meet the cone; the shaders sort them out texel by texel
};

struct PaintBenchSettings {
  PaintFrom from = PaintFrom::lists;
  std::optional<PaintBy> by;  ///< unless told otherwise whoever suits the driver
  SeenFrom seen_from = SeenFrom::outside;
  PaintPolicy policy = PaintPolicy::newest;
  double texel_mm = 0.2;
  double cone_half_angle_rad = 0.6108652381980153;  ///< 35 degrees
  double far_mm = 60;
  int frames_per_pose = 4;  ///< in a view that stands still; the first is not counted
};

/// Milliseconds, the driver waited for: on the wall clock, and of processor time over all threads, which
/// other programs disturb less.
struct Spread {
  double median_ms = 0, p95_ms = 0, max_ms = 0;
  double cpu_median_ms = 0;
};

struct PaintBenchReport {
  std::size_t triangles = 0;
  std::size_t poses = 0;  ///< that see the surface; the others are in no figure but the cutout's
  double texel_mm = 0;
  int atlas_size_texels = 0;
  std::uint32_t cutout_triangles_median = 0;  ///< painted or hiding
  std::uint32_t texels_median = 0;            ///< gone through
  Spread map;                                 ///< the cutout itself, on one thread
  Spread upload, paint;  ///< of each new frame; paint: depth of the cutout, occlusion, texels
  Spread fixed_view;     ///< upload, paint and the panel's picture, read back; the eye stands still
  Spread moving_view;    ///< the same with a new eye: above 50,000 triangles the coarser surface
  Spread full_redraw;    ///< the same, every triangle drawn
  std::string renderer;
};

/// A new 1920 x 1080 NV12 frame for every step, a panel of 1280 x 800 with all that is on it. Needs a machine
/// that can open EGL, and a pose that sees the surface. The cutout is timed apart and is in no other figure.
Result<PaintBenchReport> run_paint_bench(const Surface& surface, std::span<const Pose<M, C>> poses,
                                         const PaintBenchSettings& settings);

/// One JSON object, one line.
std::string to_json(const PaintBenchReport& report);

}  // namespace orcart
