// Corner notes in straight loops over coordinates, the exact test for the few that they leave open.
#include "realtime/mapper/cone_sieve.hpp"

#include <cmath>

namespace orcart {
namespace {

constexpr std::uint16_t kInside = 1;

/// Eight planes that touch the cone along its flank (outward normal (cos, sin) across the axis), the plane
/// through the apex, and the far plane.
constexpr float kDiagonal = 0.70710678F;
constexpr std::array<std::array<float, 2>, 8> kAround{{{1, 0},
                                                       {kDiagonal, kDiagonal},
                                                       {0, 1},
                                                       {-kDiagonal, kDiagonal},
                                                       {-1, 0},
                                                       {-kDiagonal, -kDiagonal},
                                                       {0, -1},
                                                       {kDiagonal, -kDiagonal}}};
/// Single-precision rounding must not put a touching triangle out.
constexpr float kSlack_mm = 1e-3F;

std::uint16_t bit(bool set, unsigned place) {
  return static_cast<std::uint16_t>((set ? 1U : 0U) << place);
}

}  // namespace

void ConeSieve::load(const ClusterTree::Cluster& cluster, const ViewingCone& cone) noexcept {
  const Eigen::Matrix3f& r = cone.R_CM;
  const std::size_t count = cluster.x.size();  // at most kMaxVertices
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = cluster.x[i] - cone.apex_mm.x(), dy = cluster.y[i] - cone.apex_mm.y(),
                dz = cluster.z[i] - cone.apex_mm.z();
    x_[i] = r(0, 0) * dx + r(0, 1) * dy + r(0, 2) * dz;
    y_[i] = r(1, 0) * dx + r(1, 1) * dy + r(1, 2) * dz;
    z_[i] = r(2, 0) * dx + r(2, 1) * dy + r(2, 2) * dz;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float x = x_[i], y = y_[i], z = z_[i], wide = z * cone.tangent;
    const bool inside = z >= 0 && z <= cone.far_mm && x * x + y * y <= wide * wide;
    std::uint16_t note = bit(inside, 0);
    for (unsigned k = 0; k < kAround.size(); ++k)
      note |= bit(kAround[k][0] * x + kAround[k][1] * y > wide + kSlack_mm, k + 1);
    notes_[i] =
        static_cast<std::uint16_t>(note | bit(z < -kSlack_mm, 9) | bit(z > cone.far_mm + kSlack_mm, 10));
  }
}

bool ConeSieve::meets(const std::array<std::uint8_t, 3>& corners, const ViewingCone& cone) const noexcept {
  const std::uint16_t a = notes_[corners[0]], b = notes_[corners[1]], c = notes_[corners[2]];
  if (((a | b | c) & kInside) != 0) return true;
  if ((a & b & c) != 0) return false;
  const auto corner = [this](std::uint8_t i) { return Eigen::Vector3f(x_[i], y_[i], z_[i]); };
  return meets_cone(cone, {corner(corners[0]), corner(corners[1]), corner(corners[2])});
}

}  // namespace orcart
