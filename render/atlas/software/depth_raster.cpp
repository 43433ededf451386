// Sends the triangles to the code for this processor (Highway).
#include "render/atlas/software/depth_raster.hpp"

#include <algorithm>

#include "render/shaders/wide_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/atlas/software/depth_raster.cpp"
#include <hwy/foreach_target.h>

#include "render/atlas/software/depth_raster_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

__attribute__((flatten)) void draw_depth(const DepthJob& job, std::span<const std::uint32_t> triangles) {
  DepthRules(job).draw(triangles);
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

HWY_EXPORT(draw_depth);

namespace {
constexpr std::size_t kBeyond = 16;  // a vector that begins in the last texel
}

DepthRaster::DepthRaster(const TriangleMesh& mesh, const DepthPinhole& pinhole)
    : mesh_(&mesh),
      pinhole_(pinhole),
      per_mm_(static_cast<std::size_t>(pinhole.size_texels) * static_cast<std::size_t>(pinhole.size_texels) +
              kBeyond) {}

void DepthRaster::draw(const CutoutPatch& part, const Pose<C, M>& X_CM) noexcept {
  if (part.first_part) std::fill(per_mm_.begin(), per_mm_.end(), 1 / pinhole_.far_mm);
  DepthJob job{.tangent = pinhole_.tangent,
               .near_mm = pinhole_.near_mm,
               .size_texels = pinhole_.size_texels,
               .vertices_mm = mesh_->vertices_mm.data()->data(),
               .triangles = reinterpret_cast<const std::int32_t*>(mesh_->triangles.data()->data()),
               .per_mm = per_mm_.data()};
  const Eigen::Matrix3f r = X_CM.rotation.cast<float>();
  const Eigen::Vector3f t = X_CM.translation_mm.cast<float>();
  std::copy_n(r.data(), job.R_CM.size(), job.R_CM.begin());
  std::copy_n(t.data(), job.t_CM.size(), job.t_CM.begin());
  HWY_DYNAMIC_DISPATCH(draw_depth)(job, part.triangles);
  HWY_DYNAMIC_DISPATCH(draw_depth)(job, part.occluders);
}

}  // namespace orcart
#endif
