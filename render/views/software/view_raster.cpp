// Sends vertices and triangles to the code for this processor (Highway).
#include <algorithm>
#include <cmath>

#include "render/views/software/view_job.hpp"

#include "render/shaders/wide_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/views/software/view_raster.cpp"
#include <hwy/foreach_target.h>

#include "render/views/software/view_raster_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

__attribute__((flatten)) void see_vertices(const ViewJob& job) {
  VertexRules(job).see_all();
}
__attribute__((flatten)) void see_triangles(const ViewJob& job, std::span<const std::uint32_t> indices) {
  TriangleRules(job, false).draw(indices);
}
__attribute__((flatten)) void draw_glass(const ViewJob& job, std::span<const std::uint32_t> indices) {
  TriangleRules(job, true).draw(indices);
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

HWY_EXPORT(see_vertices);
HWY_EXPORT(see_triangles);
HWY_EXPORT(draw_glass);

void see_vertices(const ViewJob& job) noexcept {
  HWY_DYNAMIC_DISPATCH(see_vertices)(job);
}
void see_triangles(const ViewJob& job, std::span<const std::uint32_t> indices) noexcept {
  HWY_DYNAMIC_DISPATCH(see_triangles)(job, indices);
}
void draw_glass(const ViewJob& job, std::span<const std::uint32_t> indices) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_glass)(job, indices);
}

}  // namespace orcart
#endif
