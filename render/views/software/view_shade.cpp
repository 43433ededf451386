// Sends the pixels to the code for this processor (Highway).
#include "render/views/software/view_job.hpp"

#include "render/shaders/wide_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/views/software/view_shade.cpp"
#include <hwy/foreach_target.h>

#include "render/views/software/view_shade_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

__attribute__((flatten)) void shade_pixels(const ShadeJob& job, const PixelBox& part) {
  ShadeRules(job).shade(part);
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

HWY_EXPORT(shade_pixels);

void shade_pixels(const ShadeJob& job, const PixelBox& part) noexcept {
  HWY_DYNAMIC_DISPATCH(shade_pixels)(job, part);
}

}  // namespace orcart
#endif
