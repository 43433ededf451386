// A slow test of a triangle against a viewing cone by another road than the product's: the reference to
// compare with.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "realtime/geometry/pose.hpp"
#include "realtime/geometry/viewing_cone.hpp"

namespace orcart::testing {

/// The greatest value over a triangle of min(z tan - rho, far - z): a concave function, so subdivision that
/// keeps the most promising quarter, bounded by its Lipschitz constant, finds it. Above zero: it meets the
/// cone. Corners in C.
inline double deepest_in_cone(const std::array<Eigen::Vector3d, 3>& corners, const ConeShape& shape,
                              double precision_mm) {
  const double tangent = std::tan(shape.half_angle_rad);
  const double steepness = std::max(1.0, std::sqrt(1 + tangent * tangent));
  const auto value = [&](const Eigen::Vector3d& p) {
    return std::min(p.z() * tangent - p.head<2>().norm(), shape.far_mm - p.z());
  };
  std::vector<std::array<Eigen::Vector3d, 3>> open{corners};
  double best = -1e300;
  while (!open.empty()) {
    const auto [a, b, c] = open.back();
    open.pop_back();
    const Eigen::Vector3d centre = (a + b + c) / 3;
    const double reach = std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()});
    const double here = value(centre);
    best = std::max({best, here, value(a), value(b), value(c)});
    if (best > 0 || here + steepness * reach < std::max(best, -precision_mm) + precision_mm) continue;
    const Eigen::Vector3d ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    open.insert(open.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return best;
}

}  // namespace orcart::testing
