// The shaders' types with a lane for each of several texels, and the functions of GLSL that the rules use:
// Highway's vectors, so compiled once for each processor target of a file that includes Highway's
// foreach_target.h; not for other files. What a function does is what the GLSL ES specification says of its
// namesake.
#if defined(ORCART_RENDER_SHADERS_WIDE) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_RENDER_SHADERS_WIDE
#undef ORCART_RENDER_SHADERS_WIDE
#else
#define ORCART_RENDER_SHADERS_WIDE
#endif

#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Reals = hn::CappedTag<float, 16>;
using Wholes = hn::Rebind<std::int32_t, Reals>;
using Whole = hn::Vec<Wholes>;

struct real {
  hn::Vec<Reals> v = hn::Zero(Reals());
  real() = default;
  HWY_INLINE real(hn::Vec<Reals> lanes) : v(lanes) {}                              // NOLINT: as in GLSL
  HWY_INLINE real(double same) : v(hn::Set(Reals(), static_cast<float>(same))) {}  // NOLINT
  HWY_INLINE real(float same) : v(hn::Set(Reals(), same)) {}                       // NOLINT
};

struct truth {
  hn::Mask<Reals> m;
};

HWY_INLINE real operator+(real a, real b) {
  return hn::Add(a.v, b.v);
}
HWY_INLINE real operator-(real a, real b) {
  return hn::Sub(a.v, b.v);
}
HWY_INLINE real operator*(real a, real b) {
  return hn::Mul(a.v, b.v);
}
HWY_INLINE real operator/(real a, real b) {
  return hn::Div(a.v, b.v);
}
HWY_INLINE real operator-(real a) {
  return hn::Neg(a.v);
}
HWY_INLINE real& operator-=(real& a, real b) {
  return a = a - b;
}
HWY_INLINE real& operator*=(real& a, real b) {
  return a = a * b;
}
HWY_INLINE truth operator<(real a, real b) {
  return {hn::Lt(a.v, b.v)};
}
HWY_INLINE truth operator>(real a, real b) {
  return {hn::Gt(a.v, b.v)};
}
HWY_INLINE truth operator<=(real a, real b) {
  return {hn::Le(a.v, b.v)};
}
HWY_INLINE truth operator>=(real a, real b) {
  return {hn::Ge(a.v, b.v)};
}
HWY_INLINE truth operator==(real a, real b) {
  return {hn::Eq(a.v, b.v)};
}

HWY_INLINE truth either(truth a, truth b) {
  return {hn::Or(a.m, b.m)};
}
HWY_INLINE truth both(truth a, truth b) {
  return {hn::And(a.m, b.m)};
}
/// `a` where it does not hold that `b`.
HWY_INLINE truth without(truth a, truth b) {
  return {hn::AndNot(b.m, a.m)};
}
HWY_INLINE bool any(truth a) {
  return !hn::AllFalse(Reals(), a.m);
}
HWY_INLINE real pick(truth condition, real a, real b) {
  return hn::IfThenElse(condition.m, a.v, b.v);
}

HWY_INLINE real min(real a, real b) {
  return hn::Min(a.v, b.v);
}
HWY_INLINE real max(real a, real b) {
  return hn::Max(a.v, b.v);
}
HWY_INLINE real clamp(real x, real low, real high) {
  return min(max(x, low), high);
}
HWY_INLINE real abs(real x) {
  return hn::Abs(x.v);
}
HWY_INLINE real floor(real x) {
  return hn::Floor(x.v);
}
HWY_INLINE real fract(real x) {
  return x - floor(x);
}
HWY_INLINE real sqrt(real x) {
  return hn::Sqrt(x.v);
}
HWY_INLINE real mod(real x, real y) {
  return x - y * floor(x / y);
}
HWY_INLINE real log2(real x) {
  return hn::Log2(Reals(), x.v);
}
HWY_INLINE real exp2(real x) {
  return hn::Exp(Reals(), (x * 0.69314718056).v);
}
HWY_INLINE real pow(real x, real y) {
  return hn::Exp(Reals(), (y * real(hn::Log(Reals(), x.v))).v);
}
HWY_INLINE real acos(real x) {
  return hn::Acos(Reals(), x.v);
}
HWY_INLINE real degrees(real x) {
  return x * 57.29577951308232;
}
HWY_INLINE real mix(real a, real b, real share) {
  return a + (b - a) * share;
}
/// Of y > -x, as the rules need it: x is a length.
HWY_INLINE real atan(real x, real z) {
  const real beyond = hn::Atan(Reals(), (min(x, abs(z)) / max(max(x, abs(z)), 1e-30)).v);
  const real of_abs = pick(x > abs(z), 1.57079632679 - beyond, beyond);
  return pick(z < 0.0, 3.14159265359 - of_abs, of_abs);
}
HWY_INLINE real smoothstep(real low, real high, real x) {
  const real t = clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

struct vec3;
struct vec2 {
  real x, y;
  vec2() = default;
  HWY_INLINE vec2(real to_x, real to_y) : x(to_x), y(to_y) {}
  HWY_INLINE explicit vec2(const vec3& p);
};

struct vec3 {
  real x, y, z;
  vec3() = default;
  HWY_INLINE vec3(real to_x, real to_y, real to_z) : x(to_x), y(to_y), z(to_z) {}
  HWY_INLINE vec3(const vec2& p, real to_z) : x(p.x), y(p.y), z(to_z) {}
  HWY_INLINE explicit vec3(real all) : x(all), y(all), z(all) {}
};
HWY_INLINE vec2::vec2(const vec3& p) : x(p.x), y(p.y) {}

struct vec4 {
  real x, y, z, w;
  vec4() = default;
  HWY_INLINE vec4(real to_x, real to_y, real to_z, real to_w) : x(to_x), y(to_y), z(to_z), w(to_w) {}
};

struct mat3 {
  vec3 columns[3];
};

#define ORCART_BY_COMPONENT(op)                               \
  HWY_INLINE vec2 operator op(const vec2& a, const vec2& b) { \
    return {a.x op b.x, a.y op b.y};                          \
  }                                                           \
  HWY_INLINE vec2 operator op(const vec2& a, real b) {        \
    return {a.x op b, a.y op b};                              \
  }                                                           \
  HWY_INLINE vec3 operator op(const vec3& a, const vec3& b) { \
    return {a.x op b.x, a.y op b.y, a.z op b.z};              \
  }                                                           \
  HWY_INLINE vec3 operator op(const vec3& a, real b) {        \
    return {a.x op b, a.y op b, a.z op b};                    \
  }
ORCART_BY_COMPONENT(+)
ORCART_BY_COMPONENT(-)
ORCART_BY_COMPONENT(*)
ORCART_BY_COMPONENT(/)
#undef ORCART_BY_COMPONENT

HWY_INLINE real dot(const vec2& a, const vec2& b) {
  return a.x * b.x + a.y * b.y;
}
HWY_INLINE real dot(const vec3& a, const vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
HWY_INLINE real length(const V& a) {
  return sqrt(dot(a, a));
}
HWY_INLINE vec3 normalize(const vec3& a) {
  return a / length(a);
}
HWY_INLINE vec3 operator*(const mat3& m, const vec3& p) {
  return m.columns[0] * p.x + m.columns[1] * p.y + m.columns[2] * p.z;
}
HWY_INLINE vec3 min(const vec3& a, const vec3& b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
HWY_INLINE vec3 clamp(const vec3& a, real low, real high) {
  return {clamp(a.x, low, high), clamp(a.y, low, high), clamp(a.z, low, high)};
}
HWY_INLINE vec2 floor(const vec2& a) {
  return {floor(a.x), floor(a.y)};
}
HWY_INLINE vec3 mix(const vec3& a, const vec3& b, real share) {
  return a + (b - a) * share;
}
HWY_INLINE vec4 mix(const vec4& a, const vec4& b, real share) {
  return {mix(a.x, b.x, share), mix(a.y, b.y, share), mix(a.z, b.z, share), mix(a.w, b.w, share)};
}
HWY_INLINE vec4 pick(truth condition, const vec4& a, const vec4& b) {
  return {pick(condition, a.x, b.x), pick(condition, a.y, b.y), pick(condition, a.z, b.z),
          pick(condition, a.w, b.w)};
}

HWY_INLINE Whole whole(real x) {
  return hn::ConvertTo(Wholes(), x.v);
}
HWY_INLINE real from_whole(Whole x) {
  return hn::ConvertTo(Reals(), x);
}
/// The byte of each lane's word that begins at this bit, 0..255.
template <int kBit>
HWY_INLINE real byte_of(Whole word) {
  return from_whole(hn::And(hn::ShiftRight<kBit>(word), hn::Set(Wholes(), 255)));
}

/// Of channels 0..1, red in the lowest byte.
HWY_INLINE Whole rgba_of(real red, real green, real blue, real alpha) {
  const auto byte = [](real channel)
                        HWY_ATTR { return hn::NearestInt((clamp(channel, 0.0, 1.0) * 255.0).v); };
  return hn::Or(hn::Or(byte(red), hn::ShiftLeft<8>(byte(green))),
                hn::Or(hn::ShiftLeft<16>(byte(blue)), hn::ShiftLeft<24>(byte(alpha))));
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
