// Which side of a triangle the scope looks at, and how steeply.
#pragma once

#include <array>

#include <Eigen/Core>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

enum class Facing { front, steep, back };

/// The side that may be painted: the outward one of a surface seen from outside, the other of one seen from
/// inside. `steep`: it faces the scope, but nowhere on it is the angle between ray and normal below the
/// limit. Corners and apex in one frame, mm; differences are taken in double precision, where those of
/// single-precision corners are exact. A triangle without area, or with the apex in its plane, is `back`: it
/// can carry no paint.
Facing facing_of(const std::array<Eigen::Vector3f, 3>& corners_mm, const Eigen::Vector3f& apex_mm,
                 SeenFrom seen_from, double cos_max_obliquity) noexcept;

}  // namespace orcart
