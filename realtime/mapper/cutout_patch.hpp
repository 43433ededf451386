// The mapper's product: which triangles a view may paint and how, in a slot that was allocated before arming.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "realtime/geometry/pose.hpp"

namespace orcart {

/// How a texel finds its place in the picture.
enum class TextureMode : std::uint8_t {
  perspective,  ///< exact projection of every texel through the calibrated lens
  paper,        ///< Dey et al. 2000: per vertex from angles about the central ray, interpolated
                ///< (paper_coordinates.hpp)
};

/// What `paper` needs besides the pose: the frame of the central ray and the lateral size of the picture
/// there. The picture is the rectified one: a square pinhole picture about C's z axis; (s, t) sees the slope
/// x/z = (2s - 1) half_width_slope, y/z = (1 - 2t) half_width_slope.
struct PaperProjection {
  bool valid = false;  ///< false: the centre ray missed; the view is refused in paper mode
  Eigen::Vector3f tip_mm = Eigen::Vector3f::Zero();  ///< P: C's origin, in M
  Eigen::Vector3f view = Eigen::Vector3f::UnitZ();   ///< PO, unit, in M
  Eigen::Vector3f up = Eigen::Vector3f::UnitY();     ///< U: the t direction, unit, in M (-y of C)
  Eigen::Vector3f side = Eigen::Vector3f::UnitX();   ///< W = view x U: the s direction
  float s_size_mm = 0;                               ///< S1
  float t_size_mm = 0;                               ///< T1
  float half_width_slope = 0;                        ///< tangent of the cone's half angle
};

/// The five rays of step 5: hits on the surface in M (mm), in the order centre, left, right, top, bottom. In
/// perspective mode the edges are those of the mask circle, through the lens; in paper mode the rectified
/// picture's.
struct FiveRays {
  std::array<Eigen::Vector3f, 5> hit_mm{};
  std::array<float, 5> distance_mm{};  ///< along the ray; negative: missed
};

/// One view's triangles, in parts. A triangle of the cone is in exactly one list of one part. Paper mode
/// tests neither facing nor occlusion: all are in `triangles`.
struct CutoutPatch {
  Pose<M, C> X_MC;
  TextureMode mode = TextureMode::perspective;
  FiveRays rays;
  PaperProjection paper;
  std::vector<std::uint32_t> triangles;  ///< to paint; capacity is reserved before arming and never exceeded
  std::vector<std::uint32_t>
      occluders;           ///< they hide, and get no paint: facing away, too steep, or hidden themselves
  bool first_part = true;  ///< false: goes on where an earlier part of the same view stopped
  bool last_part = true;   ///< false: the cap was reached; the rest comes with the next step
  std::uint32_t triangles_in_cone = 0;  ///< of this part: at least partly in the viewing cone

  explicit CutoutPatch(std::size_t capacity = 0) {
    for (auto* const list : {&triangles, &occluders}) {
      list->resize(capacity);  // touched, not only reserved: no step fetches a page
      list->clear();
    }
  }
};

}  // namespace orcart
