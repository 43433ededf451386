// Which texels a triangle covers, with barycentric coordinates: centres, and those within a margin of its
// edges.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

namespace orcart {

using FlatTriangle = std::array<Eigen::Vector2f, 3>;

/// Twice the signed area, texels squared.
inline float doubled_area(const FlatTriangle& t) {
  const Eigen::Vector2f a = t[1] - t[0], b = t[2] - t[0];
  return a.x() * b.y() - a.y() * b.x();
}

/// Distance from a point to the nearest edge of the triangle.
inline float edge_distance(const FlatTriangle& t, const Eigen::Vector2f& p) {
  float nearest = INFINITY;
  for (int e = 0; e < 3; ++e) {
    const Eigen::Vector2f& a = t[static_cast<std::size_t>(e)];
    const Eigen::Vector2f& b = t[static_cast<std::size_t>((e + 1) % 3)];
    const Eigen::Vector2f ab = b - a;
    const float length2 = ab.squaredNorm();
    const float s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0f, 1.0f) : 0.0f;
    nearest = std::min(nearest, (p - a - s * ab).norm());
  }
  return nearest;
}

/// Calls visit(x, y, b1, b2, distance) for every texel whose centre lies in the triangle (distance 0) or
/// within `margin` of it; texels are clipped to [0,width) x [0,height). Triangles without area are passed
/// over.
template <class Visit>
void for_each_texel(const FlatTriangle& t, float margin, int width, int height, Visit visit) {
  const float area2 = doubled_area(t);
  if (std::abs(area2) < 1e-9f) return;
  const auto low = [&](int axis) { return std::min({t[0][axis], t[1][axis], t[2][axis]}) - margin - 0.5f; };
  const auto high = [&](int axis) { return std::max({t[0][axis], t[1][axis], t[2][axis]}) + margin - 0.5f; };
  const int x0 = std::max(0, static_cast<int>(std::ceil(low(0)))),
            x1 = std::min(width - 1, static_cast<int>(std::floor(high(0))));
  const int y0 = std::max(0, static_cast<int>(std::ceil(low(1)))),
            y1 = std::min(height - 1, static_cast<int>(std::floor(high(1))));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float b1 = doubled_area({t[0], p, t[2]}) / area2, b2 = doubled_area({t[0], t[1], p}) / area2;
      if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1) {
        visit(x, y, b1, b2, 0.0f);
      } else if (margin > 0) {
        const float distance = edge_distance(t, p);
        if (distance <= margin) visit(x, y, b1, b2, distance);
      }
    }
  }
}

}  // namespace orcart
