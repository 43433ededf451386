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

void Occlusion::trace(const RayScene& surface, std::size_t count) noexcept {
  surface.hidden_many(apex_mm_, {point_mm_.data(), count}, kMargin_mm, {hidden_.data(), count});
  rays_ += static_cast<std::uint32_t>(count);
}

/// Brings the stamps of the triangles' corners up to this view.
void Occlusion::trace_vertices(const RayScene& surface, const ClusterTree::Cluster& cluster,
                               std::uint64_t which) noexcept {
  std::size_t count = 0;
  for (; which != 0; which &= which - 1)
    for (const std::uint8_t corner : cluster.corners[static_cast<std::size_t>(__builtin_ctzll(which))]) {
      const std::uint32_t vertex = cluster.vertex_ids[corner];
      if (seen_at_[vertex] >> 1 == view_) continue;
      seen_at_[vertex] = view_ << 1;
      owner_[count] = vertex;
      point_mm_[count++] = {cluster.x[corner], cluster.y[corner], cluster.z[corner]};
    }
  trace(surface, count);
  for (std::size_t i = 0; i < count; ++i) seen_at_[owner_[i]] |= hidden_[i];
}

std::uint64_t Occlusion::hidden(const RayScene& surface, const ClusterTree::Cluster& cluster,
                                std::uint64_t which) noexcept {
  trace_vertices(surface, cluster, which);
  std::size_t count = 0;
  for (; which != 0; which &= which - 1) {
    const auto triangle = static_cast<std::uint32_t>(__builtin_ctzll(which));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    std::uint32_t all_hidden = 1;
    for (const std::uint8_t corner : cluster.corners[triangle]) {
      all_hidden &= seen_at_[cluster.vertex_ids[corner]];
      sum += Eigen::Vector3f(cluster.x[corner], cluster.y[corner], cluster.z[corner]);
    }
    if ((all_hidden & 1U) == 0) continue;
    owner_[count] = triangle;
    point_mm_[count++] = sum / 3;
  }
  trace(surface, count);
  std::uint64_t behind = 0;
  for (std::size_t i = 0; i < count; ++i) behind |= std::uint64_t{hidden_[i]} << owner_[i];
  return behind;
}

}  // namespace orcart
