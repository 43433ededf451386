// Texel by texel: the paper's (s, t) from its triangle's corners, that pixel's ray, and where it meets the
// surface.
#include "firmware-host/offline/mode_difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "realtime/mapper/paper_coordinates.hpp"

namespace orcart {
namespace {

class Differ {
 public:
  Differ(const TriangleMesh& mesh, const RayScene& rays, const AtlasLayout& layout, const CutoutPatch& view,
         double far_mm)
      : mesh_(mesh), rays_(rays), layout_(layout), view_(view), far_mm_(far_mm) {}

  ModeDifference all() {
    std::vector<std::uint8_t> in_cutout(mesh_.triangles.size(), 0);
    for (const std::uint32_t triangle : view_.triangles) in_cutout[triangle] = 1;
    std::vector<float> displacement_mm(layout_.owners.size(), ModeDifference::kOutside);
    std::size_t lost = 0;
    for (std::size_t i = 0; i < layout_.owners.size(); ++i) {
      if (layout_.inside[i] == 0 || in_cutout[layout_.owners[i].triangle] == 0) continue;
      const Eigen::Vector3f p = point_of(layout_.owners[i]);
      if (!in_sight(p)) continue;
      const auto shown = shown_at(layout_.owners[i]);
      if (!shown) {
        ++lost;
        continue;
      }
      displacement_mm[i] = (*shown - p).norm();
    }
    return figures_of(std::move(displacement_mm), lost);
  }

 private:
  std::array<Eigen::Vector3f, 3> corners_of(std::uint32_t triangle) const {
    const auto& t = mesh_.triangles[triangle];
    return {mesh_.vertices_mm[t[0]], mesh_.vertices_mm[t[1]], mesh_.vertices_mm[t[2]]};
  }

  Eigen::Vector3f point_of(const TexelOwner& owner) const {
    const auto [a, b, c] = corners_of(owner.triangle);
    return a + owner.b1 * (b - a) + owner.b2 * (c - a);
  }

  bool in_sight(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f ray = p - view_.paper.tip_mm;
    const float depth_mm = ray.dot(view_.paper.view),
                across = 1 + view_.paper.half_width_slope * view_.paper.half_width_slope;
    constexpr float kOwnMargin_mm = 0.05F;
    return depth_mm > 0 && ray.squaredNorm() < depth_mm * depth_mm * across &&
           !rays_.hidden(view_.paper.tip_mm, p, kOwnMargin_mm);
  }

  /// The point whose light paper mode puts at a texel.
  std::optional<Eigen::Vector3f> shown_at(const TexelOwner& owner) const {
    const auto corners = corners_of(owner.triangle);
    std::array<Eigen::Vector2f, 3> st;
    for (std::size_t c = 0; c < 3; ++c) st[c] = paper_coordinates(view_.paper, corners[c]);
    const Eigen::Vector2f at = st[0] + owner.b1 * (st[1] - st[0]) + owner.b2 * (st[2] - st[0]);
    if (((at.array() - 0.5F).abs() > 0.5F).any()) return std::nullopt;
    const PaperProjection& paper = view_.paper;
    const Eigen::Vector2f slope = (2 * at.array() - 1) * paper.half_width_slope;
    const Eigen::Vector3f ray = (paper.view + slope.x() * paper.side + slope.y() * paper.up).normalized();
    const auto hit = rays_.nearest(paper.tip_mm, ray, static_cast<float>(far_mm_) * 2);
    if (!hit) return std::nullopt;
    return paper.tip_mm + hit->distance_mm * ray;
  }

  const TriangleMesh& mesh_;
  const RayScene& rays_;
  const AtlasLayout& layout_;
  const CutoutPatch& view_;
  double far_mm_;
};

}  // namespace

ModeDifference figures_of(std::vector<float> displacement_mm, std::size_t lost) {
  ModeDifference figures{.displacement_mm = std::move(displacement_mm), .lost = lost};
  std::vector<float> sorted;
  for (const float mm : figures.displacement_mm)
    if (mm >= 0) sorted.push_back(mm);
  if (sorted.empty()) return figures;
  std::sort(sorted.begin(), sorted.end());
  figures.texels = sorted.size();
  for (const float mm : sorted)
    figures.mean_mm += static_cast<double>(mm) / static_cast<double>(sorted.size());
  figures.p95_mm = static_cast<double>(sorted[sorted.size() * 95 / 100]);
  figures.max_mm = static_cast<double>(sorted.back());
  return figures;
}

ModeDifference difference_between_modes(const TriangleMesh& mesh, const RayScene& rays,
                                        const AtlasLayout& layout, const CutoutPatch& view, double far_mm) {
  return Differ(mesh, rays, layout, view, far_mm).all();
}

}  // namespace orcart
