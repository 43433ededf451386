// The camera's picture in memory, looked at by the rules of the shaders. For files that include wide.hpp,
// each processor target anew.
#if defined(ORCART_RENDER_ATLAS_SOFTWARE_PICTURE_RULES) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_RENDER_ATLAS_SOFTWARE_PICTURE_RULES
#undef ORCART_RENDER_ATLAS_SOFTWARE_PICTURE_RULES
#else
#define ORCART_RENDER_ATLAS_SOFTWARE_PICTURE_RULES
#endif

#include "render/atlas/paint_uniforms.hpp"
#include "render/gles/picture_planes.hpp"
#include "render/shaders/wide.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

struct WideUniforms {
#define uniform
#include "render/shaders/paint_uniforms.glsl"
#undef uniform
};

/// Each number in all lanes.
HWY_INLINE WideUniforms spread(const PaintUniforms& uniforms) {
  constexpr std::size_t kCount = sizeof(PaintUniforms) / sizeof(float);
  const auto numbers = std::bit_cast<std::array<float, kCount>>(uniforms);
  std::array<real, kCount> same;
  for (std::size_t i = 0; i < kCount; ++i) same[i] = numbers[i];
  return std::bit_cast<WideUniforms>(same);
}

/// Pixels of the picture, for as many places as there are lanes.
class PictureRules : protected WideUniforms {
 public:
  PictureRules(const PaintUniforms& uniforms, const gles::PicturePlanes& picture)
      : WideUniforms(spread(uniforms)), picture_(picture) {}

 protected:
#define PICTURE_FORMAT picture_.format
#include "render/shaders/picture.glsl"
#undef PICTURE_FORMAT

  static hn::Mask<Wholes> whole_mask(truth a) {
    return hn::RebindMask(Wholes(), a.m);
  }

 private:
  vec4 luma_at(const vec2& uv, real level) const {
    return between_levels(picture_.luma, uv, level);
  }
  vec4 chroma_at(const vec2& uv, real level) const {
    return between_levels(picture_.chroma, uv, level);
  }

  static vec4 between_levels(const gles::PictureLevels& plane, const vec2& uv, real level) {
    const real most = static_cast<double>(plane.count - 1);
    const real held = clamp(level, 0.0, most), finer = floor(held), share = held - finer;
    const vec4 fine = within_level(plane, uv, finer);
    if (!any(share > 0.0)) return fine;
    return mix(fine, within_level(plane, uv, min(finer + 1.0, most)), share);
  }

  /// Bilinear. One word of a row holds both neighbours where a texel has one or two bytes.
  static vec4 within_level(const gles::PictureLevels& plane, const vec2& uv, real level) {
    const Whole halvings = whole(level), one = hn::Set(Wholes(), 1);
    const Whole width = hn::Set(Wholes(), plane.width) >> halvings,
                height = hn::Set(Wholes(), plane.height) >> halvings;
    const real last_x = from_whole(width) - 1.0, last_y = from_whole(height) - 1.0;
    const real x = clamp(uv.x * from_whole(width) - 0.5, 0.0, last_x),
               y = clamp(uv.y * from_whole(height) - 0.5, 0.0, last_y);
    const real left = max(min(floor(x), last_x - 1.0), 0.0), above = max(min(floor(y), last_y - 1.0), 0.0);
    const Whole channels = hn::Set(Wholes(), plane.channels), row_bytes = hn::Mul(width, channels);
    const Whole offset = hn::Add(hn::GatherIndex(Wholes(), plane.offset_bytes.data(), halvings),
                                 hn::Add(hn::Mul(whole(above), row_bytes), hn::Mul(whole(left), channels)));
    const Whole below = hn::Add(offset, hn::IfThenElseZero(hn::Gt(height, one), row_bytes));
    const real across = x - left, down = y - above;
    return mix(along_row(plane, offset, across), along_row(plane, below, across), down);
  }

  static Whole word_at(const gles::PictureLevels& plane, Whole offset_bytes) {
    return hn::GatherOffset(Wholes(), reinterpret_cast<const std::int32_t*>(plane.first), offset_bytes);
  }

  static vec4 along_row(const gles::PictureLevels& plane, Whole offset_bytes, real share) {
    constexpr double kScale = 1.0 / 255.0;
    const Whole word = word_at(plane, offset_bytes);
    if (plane.channels == 1) return {mix(byte_of<0>(word), byte_of<8>(word), share) * kScale, 0.0, 0.0, 1.0};
    if (plane.channels == 2)
      return {mix(byte_of<0>(word), byte_of<16>(word), share) * kScale,
              mix(byte_of<8>(word), byte_of<24>(word), share) * kScale, 0.0, 1.0};
    const Whole next = word_at(
        plane, hn::Add(offset_bytes, hn::IfThenElseZero(whole_mask(share > 0.0), hn::Set(Wholes(), 4))));
    return {mix(byte_of<0>(word), byte_of<0>(next), share) * kScale,
            mix(byte_of<8>(word), byte_of<8>(next), share) * kScale,
            mix(byte_of<16>(word), byte_of<16>(next), share) * kScale,
            mix(byte_of<24>(word), byte_of<24>(next), share) * kScale};
  }

  const gles::PicturePlanes& picture_;
};

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
