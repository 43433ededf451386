// How pictures are put onto the surface: what a person chooses, and what a view's pose is worth.
#pragma once

#include <cstdint>

#include "realtime/geometry/triangle_mesh.hpp"
#include "render/egl/context.hpp"
#include "render/gles/picture_copy.hpp"

namespace orcart {

/// Which picture a texel keeps that several have seen.
enum class PaintPolicy : std::uint8_t {
  newest,  ///< Dey et al. 2000: the newest picture wins
  best,    ///< the picture in which a pixel covers least of the surface: resolution and angle decide
};

/// What becomes of the light's own mirror images, which show nothing of the tissue.
enum class Highlights : std::uint8_t {
  yield,  ///< they give way to any other picture, and never cover one
  keep,   ///< painted as everything else: for targets that are white themselves
};

/// How the fall of the light with distance, angle and vignetting is evened out.
enum class LightModel : std::uint8_t {
  as_seen,         ///< not at all
  fixed_exposure,  ///< to the brightness at ScopeModel::fall_off's reference distance
  auto_exposure,   ///< to the mean light of the view itself, for a camera that sets its gain picture by
                   ///< picture
};

/// Who goes through the texels. Both by the same rules, to within a level of a colour.
enum class PaintBy : std::uint8_t {
  gpu,        ///< the driver
  processor,  ///< the processor's vector units, where the driver would be a slower program on the same
              ///< processor; in the paper's mode the driver all the same
};

constexpr PaintBy paint_by_for(RenderClass driver) noexcept {
  return driver == RenderClass::software ? PaintBy::processor : PaintBy::gpu;
}

struct PainterSettings {
  SeenFrom seen_from = SeenFrom::outside;
  int undo_units = 16;                            ///< how many units can be taken back
  std::uint32_t max_texels_per_step = 1'500'000;  ///< at least a cell of 16 x 16
  double max_obliquity_rad = 1.3963;
  PaintPolicy policy = PaintPolicy::newest;
  Highlights highlights = Highlights::keep;
  LightModel light = LightModel::as_seen;
  PictureCopy picture_copy = PictureCopy::cpu;  ///< cpu where the processor paints
  PaintBy paint_by = PaintBy::gpu;
};

/// What a view's pose and calibration leave open, each as RMS over both axes across the line of sight. The
/// record's predicted error at distance d, where a pixel spans f mm across the line of sight, and angle a
/// from the normal: sqrt(position^2 + (angle d)^2 + (pixels f)^2) sqrt((1 + 1 / cos^2 a) / 2), since the
/// slant stretches one of the two axes.
struct ViewError {
  float position_mm = 0;
  float angle_rad = 0;
  float pixels = 0;
};

}  // namespace orcart
