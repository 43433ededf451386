// The rules of the paint shader, compiled for the processor's vectors: the same files that the driver
// compiles. For files that include wide.hpp, each processor target anew.
#if defined(ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES
#undef ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES
#else
#define ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES
#endif

#include "render/atlas/software/texel_job.hpp"
#include "render/atlas/software/wide.hpp"

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

/// As many texels of a row as there are lanes, one after the other.
class TexelRules : private WideUniforms {
 public:
  explicit TexelRules(const TexelJob& job) : WideUniforms(spread(job.uniforms)), job_(job) {}

  /// The texels from this one on.
  void paint(std::size_t first) {
    const TexelMemory& atlas = job_.atlas;
    const Reals d;
    texel_ = first;
    alive_ = real(0.0) == real(0.0);
    paint_texel({hn::LoadU(d, atlas.x_mm + first), hn::LoadU(d, atlas.y_mm + first),
                 hn::LoadU(d, atlas.z_mm + first)},
                hn::LoadU(d, atlas.normal + first));
  }

 private:
#define LENS_MODEL job_.choices.lens_model
#define BEST job_.choices.best
#define YIELD job_.choices.yield
#define LIGHT job_.choices.light
#define PICTURE_FORMAT job_.picture.format
#define WHERE_ANY(condition) if (any(condition))
#define GIVE_UP_WHERE(condition)         \
  alive_ = without(alive_, (condition)); \
  if (!any(alive_)) return
#include "render/shaders/lens.glsl"
#include "render/shaders/light.glsl"
#include "render/shaders/mask.glsl"
#include "render/shaders/picture.glsl"
#include "render/shaders/record.glsl"
#include "render/shaders/visible.glsl"
// last: it uses all the others
#include "render/shaders/paint_texel.glsl"
#undef LENS_MODEL
#undef BEST
#undef YIELD
#undef LIGHT
#undef PICTURE_FORMAT
#undef WHERE_ANY
#undef GIVE_UP_WHERE

  // What a shader's textures and outputs are.
  real seen_at(const vec2& at) const {
    const real last = u_depth_size - 1.0;
    const Whole x = whole(clamp(at.x, 0.0, last)), y = whole(clamp(at.y, 0.0, last));
    return hn::GatherIndex(Reals(), job_.depths.per_mm,
                           hn::Add(hn::Mul(y, hn::Set(Wholes(), job_.depths.size_texels)), x));
  }

  vec4 luma_at(const vec2& uv, real level) const {
    return between_levels(job_.picture.luma, uv, level);
  }
  vec4 chroma_at(const vec2& uv, real level) const {
    return between_levels(job_.picture.chroma, uv, level);
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

  static hn::Mask<Wholes> whole_mask(truth a) {
    return hn::RebindMask(Wholes(), a.m);
  }

  using Halves = hn::Rebind<std::uint16_t, Reals>;
  static real from_half(hn::Vec<Halves> half) {
    return from_whole(hn::PromoteTo(Wholes(), half));
  }
  static hn::Vec<Halves> half(real value) {
    return hn::DemoteTo(Halves(), whole(value));
  }

  vec4 record_before() const {
    hn::Vec<Halves> capture, angle, footprint, error;
    hn::LoadInterleaved4(Halves(), &job_.atlas.records[texel_].capture, capture, angle, footprint, error);
    return {from_half(capture), from_half(angle), from_half(footprint), from_half(error)};
  }

  /// Colour over colour by the weight, and the record with it, where nothing has been given up.
  void keep(const vec3& colour, real weight, const vec4& record) {
    std::uint32_t* const colours = job_.atlas.colours + texel_;
    auto* const words = reinterpret_cast<std::int32_t*>(colours);
    const Whole before = hn::LoadU(Wholes(), words);
    const auto blended = [&](real now, real then)
                             HWY_ATTR { return hn::NearestInt(mix(then, now * 255.0, weight).v); };
    const Whole red = blended(colour.x, byte_of<0>(before)), green = blended(colour.y, byte_of<8>(before)),
                blue = blended(colour.z, byte_of<16>(before)), cover = blended(1.0, byte_of<24>(before));
    const Whole after = hn::Or(hn::Or(red, hn::ShiftLeft<8>(green)),
                               hn::Or(hn::ShiftLeft<16>(blue), hn::ShiftLeft<24>(cover)));
    hn::StoreU(hn::IfThenElse(whole_mask(alive_), after, before), Wholes(), words);
    const vec4 was = record_before(), is = pick(alive_, record, was);
    hn::StoreInterleaved4(half(is.x), half(is.y), half(is.z), half(is.w), Halves(),
                          &job_.atlas.records[texel_].capture);
  }

  const TexelJob& job_;
  std::size_t texel_ = 0;
  truth alive_{};
};

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
