// Edge by edge: the stretch of each within the cone, strung together.
#include "realtime/mapper/cone_clip.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {
namespace {

struct Stretch {
  double first = 0, last = -1;  ///< fractions of the edge; nothing where last < first
};

/// Where q(t) = a t^2 + 2 b t + c >= 0 for the nappe that the edge is on; the cone is convex, so it is one
/// stretch.
void keep_in_nappe(Stretch& stretch, double a, double b, double c, double rise) {
  if (a == 0) {
    if (b > 0) stretch.first = std::max(stretch.first, -c / (2 * b));
    if (b < 0) stretch.last = std::min(stretch.last, -c / (2 * b));
    if (b == 0 && c < 0) stretch.last = -1;
    return;
  }
  const double under_root = b * b - a * c;
  if (a < 0 && under_root < 0) {
    stretch.last = -1;
    return;
  }
  const double w = -(b + std::copysign(std::sqrt(std::max(under_root, 0.0)), b));
  const double one = w / a, other = w == 0 ? one : c / w;
  const double low = std::min(one, other), high = std::max(one, other);
  if (a < 0) {
    stretch.first = std::max(stretch.first, low);
    stretch.last = std::min(stretch.last, high);
  } else if (rise > 0) {
    stretch.first = std::max(stretch.first, high);
  } else {
    stretch.last = std::min(stretch.last, low);
  }
}

Stretch stretch_in_cone(const ConeNumbers& cone, const std::array<float, 3>& from,
                        const std::array<float, 3>& to) {
  const double tangent2 = double{cone.tangent} * cone.tangent;
  const double x = from[0], y = from[1], z = from[2];
  const double dx = to[0] - x, dy = to[1] - y, dz = to[2] - z;
  Stretch stretch{.first = 0, .last = 1};
  const auto keep = [&](double value, double slope) {  // value + t slope >= 0
    if (slope > 0) stretch.first = std::max(stretch.first, -value / slope);
    if (slope < 0) stretch.last = std::min(stretch.last, -value / slope);
    if (slope == 0 && value < 0) stretch.last = -1;
  };
  keep(z, dz);
  keep(cone.far_mm - z, -dz);
  keep_in_nappe(stretch, tangent2 * dz * dz - dx * dx - dy * dy, tangent2 * z * dz - x * dx - y * dy,
                tangent2 * z * z - x * x - y * y, dz);
  return stretch;
}

}  // namespace

ClipPolygon clip_to_cone(const ConeNumbers& cone, const ClipTriangle& triangle, bool outer_edges) noexcept {
  ClipPolygon polygon;
  const auto add = [&](std::size_t from, std::size_t to, double fraction) {
    polygon.point[polygon.size++] = {.from = static_cast<std::uint8_t>(from),
                                     .to = static_cast<std::uint8_t>(to),
                                     .fraction = static_cast<float>(std::clamp(fraction, 0.0, 1.0))};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = i == 2 ? 0 : i + 1;
    const bool in = triangle.inside[i], out = triangle.inside[j];
    if (in) add(i, i, 0);
    if ((in && out) || (!in && !out && !outer_edges)) continue;
    // From the inner corner outwards, or in the order of the coordinates: both neighbours do the same.
    const bool turned = in == out ? triangle.corner[j] < triangle.corner[i] : out;
    const std::size_t from = turned ? j : i, to = turned ? i : j;
    const Stretch stretch = stretch_in_cone(cone, triangle.corner[from], triangle.corner[to]);
    if (in != out) {
      add(from, to, stretch.last);
    } else if (stretch.last >= stretch.first) {
      add(from, to, turned ? stretch.last : stretch.first);
      add(from, to, turned ? stretch.first : stretch.last);
    }
  }
  return polygon;
}

}  // namespace orcart
