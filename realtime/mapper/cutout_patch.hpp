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
  paper,        ///< Dey et al. 2000: per vertex from angles about the central ray, interpolated (METHOD: equations 2-6)
};

/// What `paper` needs besides the pose: the frame of the central ray and the lateral size of the picture there.
struct PaperProjection {
  bool valid = false;      ///< false: the centre ray missed; the view is refused in paper mode
  Eigen::Vector3f tip_mm = Eigen::Vector3f::Zero();      ///< P: C's origin, in M
  Eigen::Vector3f view = Eigen::Vector3f::UnitZ();       ///< PO, unit, in M
  Eigen::Vector3f up = Eigen::Vector3f::UnitY();         ///< U: the t direction, unit, in M (-y of C)
  Eigen::Vector3f side = Eigen::Vector3f::UnitX();       ///< W = view x U: the s direction
  float s_size_mm = 0;     ///< S1
  float t_size_mm = 0;     ///< T1
};

/// The five rays of step 5: hits on the surface in M (mm), in the order centre, left, right, top, bottom.
struct FiveRays {
  std::array<Eigen::Vector3f, 5> hit_mm{};
  std::array<float, 5> distance_mm{};  ///< along the ray; negative: missed
};

/// One view's triangles. A triangle is listed when it lies at least partly in the viewing cone, faces the scope (in
/// perspective mode) and was not found hidden. Never more than capacity.
struct CutoutPatch {
  Pose<M, C> X_MC;
  TextureMode mode = TextureMode::perspective;
  FiveRays rays;
  PaperProjection paper;
  std::vector<std::uint32_t> triangles;  ///< capacity is reserved before arming; size never exceeds it
  std::vector<std::uint32_t> occluders;  ///< triangles inside the cone that face away: they hide, and get no paint
  bool first_part = true;     ///< false: goes on where an earlier part of the same view stopped
  bool last_part = true;      ///< false: the cap was reached; the rest comes with the next step
  std::uint32_t triangles_in_cone = 0;

  explicit CutoutPatch(std::size_t capacity = 0) {
    triangles.reserve(capacity);
    occluders.reserve(capacity);
  }
};

}  // namespace orcart
