// Occlusion rays, with the answers per vertex stamped by view so that nothing needs clearing.
#include "realtime/mapper/occlusion.hpp"

#include <algorithm>

namespace orcart {
namespace {

/// The end of a ray that is not looked at: the triangle itself and its neighbours lie there.
constexpr float kMargin_mm = 0.05F;
constexpr std::uint32_t kLastView = 0x7FFFFFFFU;

}  // namespace

void Occlusion::begin(const Eigen::Vector3f& apex_mm) noexcept {
  if (view_ == kLastView) {
    std::fill(seen_at_.begin(), seen_at_.end(), 0U);
    view_ = 0;
  }
  ++view_;
  rays_ = 0;
  apex_mm_ = apex_mm;
}

bool Occlusion::vertex_hidden(const RayScene& surface, std::uint32_t vertex,
                              const Eigen::Vector3f& at_mm) noexcept {
  std::uint32_t& stamp = seen_at_[vertex];
  if (stamp >> 1 != view_) {
    ++rays_;
    stamp = view_ << 1 | (surface.hidden(apex_mm_, at_mm, kMargin_mm) ? 1U : 0U);
  }
  return (stamp & 1U) != 0;
}

bool Occlusion::hidden(const RayScene& surface, const std::array<std::uint32_t, 3>& vertices,
                       const std::array<Eigen::Vector3f, 3>& corners_mm) noexcept {
  for (std::size_t i = 0; i < 3; ++i)
    if (!vertex_hidden(surface, vertices[i], corners_mm[i])) return false;
  ++rays_;
  return surface.hidden(apex_mm_, (corners_mm[0] + corners_mm[1] + corners_mm[2]) / 3, kMargin_mm);
}

}  // namespace orcart
