// The rules of the paint shader, compiled for the processor's vectors: the same files that the driver
// compiles. For files that include wide.hpp, each processor target anew.
#if defined(ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES
#undef ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES
#else
#define ORCART_RENDER_ATLAS_SOFTWARE_TEXEL_RULES
#endif

#include "render/atlas/software/picture_rules.hpp"
#include "render/atlas/software/texel_job.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

/// As many texels of a row as there are lanes, one after the other.
class TexelRules : private PictureRules {
 public:
  explicit TexelRules(const TexelJob& job) : PictureRules(job.uniforms, job.picture), job_(job) {}

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
#define WHERE_ANY(condition) if (any(condition))
#define GIVE_UP_WHERE(condition)         \
  alive_ = without(alive_, (condition)); \
  if (!any(alive_)) return
#include "render/shaders/lens.glsl"
#include "render/shaders/light.glsl"
#include "render/shaders/mask.glsl"
#include "render/shaders/record.glsl"
#include "render/shaders/visible.glsl"
// last: it uses all the others
#include "render/shaders/paint_texel.glsl"
#undef LENS_MODEL
#undef BEST
#undef YIELD
#undef LIGHT
#undef WHERE_ANY
#undef GIVE_UP_WHERE

  // What a shader's textures and outputs are.
  real seen_at(const vec2& at) const {
    const real last = u_depth_size - 1.0;
    const Whole x = whole(clamp(at.x, 0.0, last)), y = whole(clamp(at.y, 0.0, last));
    return hn::GatherIndex(Reals(), job_.depths.per_mm,
                           hn::Add(hn::Mul(y, hn::Set(Wholes(), job_.depths.size_texels)), x));
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
