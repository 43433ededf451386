// The few decisions that single precision and planes leave open.
#include "realtime/mapper/cone_sieve.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {
namespace {

/// Single-precision rounding must not put a touching triangle out.
constexpr float kSlack_mm = 1e-3F;

/// Whether the plane along the cone's flank on the side of corner `at` has all three beyond it.
bool beyond_own_plane(const std::array<Eigen::Vector3f, 3>& p, std::size_t at, float tangent) {
  const float rho = p[at].head<2>().norm();
  return std::all_of(p.begin(), p.end(), [&](const Eigen::Vector3f& q) {
    return q.head<2>().dot(p[at].head<2>()) > rho * (tangent * q.z() + kSlack_mm);
  });
}

}  // namespace

bool point_in_cone(const ConeNumbers& cone, float x_mm, float y_mm, float z_mm) noexcept {
  const double d[3] = {double{x_mm} - cone.apex_mm[0], double{y_mm} - cone.apex_mm[1],
                       double{z_mm} - cone.apex_mm[2]};
  double p[3];
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = cone.R_CM[3 * i] * d[0] + cone.R_CM[3 * i + 1] * d[1] + cone.R_CM[3 * i + 2] * d[2];
  const double wide = p[2] * cone.tangent;
  return p[2] >= 0 && p[2] <= cone.far_mm && p[0] * p[0] + p[1] * p[1] <= wide * wide;
}

std::uint64_t meeting_of(const SieveScratch& scratch, const std::uint8_t* corners, const ConeNumbers& cone,
                         std::uint64_t open) noexcept {
  ViewingCone shape;
  shape.tangent = cone.tangent;
  shape.far_mm = cone.far_mm;
  std::uint64_t meets = 0;
  for (; open != 0; open &= open - 1) {
    const auto triangle = static_cast<std::size_t>(__builtin_ctzll(open));
    std::array<Eigen::Vector3f, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint8_t at = corners[3 * triangle + c];
      p[c] = {scratch.x[at], scratch.y[at], scratch.z[at]};
    }
    if (beyond_own_plane(p, 0, cone.tangent) || beyond_own_plane(p, 1, cone.tangent) ||
        beyond_own_plane(p, 2, cone.tangent))
      continue;
    if (meets_cone(shape, p)) meets |= std::uint64_t{1} << triangle;
  }
  return meets;
}

}  // namespace orcart
