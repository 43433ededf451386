// Row by row, a vector of pixels at a time, chosen for the processor when first run (Highway).
#include <array>
#include <bit>

#include "render/views/software/inset_job.hpp"

#include "render/shaders/wide_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/views/software/inset.cpp"
#include <hwy/foreach_target.h>

#include "render/atlas/software/picture_rules.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

class InsetRules : private PictureRules {
 public:
  explicit InsetRules(const InsetJob& job) : PictureRules(job.uniforms, job.picture), job_(job) {}

  void draw() {
    for (int y = 0; y < job_.height; ++y)
      for (int x = 0; x < job_.width; x += static_cast<int>(hn::Lanes(Reals()))) draw(x, y);
  }

 private:
#include "render/shaders/inset.glsl"

  void draw(int x, int y) {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(job_.stride) + static_cast<std::size_t>(x);
    const Whole under = hn::LoadU(Wholes(), reinterpret_cast<const std::int32_t*>(job_.under + pixel));
    auto* const to = reinterpret_cast<std::int32_t*>(job_.shown + pixel);
    const real column = hn::Iota(Reals(), static_cast<float>(x) + 0.5F), row = static_cast<double>(y) + 0.5;
    const vec2 place = vec2(column - job_.centre_x, row - job_.centre_y) / job_.radius_px;
    const real cover = inset_cover(place, job_.radius_px);
    if (!any(cover > 0.0)) {
      hn::StoreU(under, Wholes(), to);
      return;
    }
    const vec3 live = inset_colour(place, job_.radius_px);
    const vec3 below = vec3(byte_of<0>(under), byte_of<8>(under), byte_of<16>(under)) * (1 / 255.0);
    const vec3 colour = mix(below, live, cover);
    hn::StoreU(rgba_of(colour.x, colour.y, colour.z, 1.0), Wholes(), to);
  }

  const InsetJob& job_;
};

__attribute__((flatten)) void draw_inset(const InsetJob& job) {
  InsetRules(job).draw();
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

HWY_EXPORT(draw_inset);

void draw_inset(const InsetJob& job) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_inset)(job);
}

}  // namespace orcart
#endif
