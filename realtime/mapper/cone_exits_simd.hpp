// Where edges leave the viewing cone; compiled once for each processor target of a
// file that includes Highway's foreach_target.h; not for other files.
#if defined(ORCART_REALTIME_MAPPER_CONE_EXITS_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_REALTIME_MAPPER_CONE_EXITS_SIMD
#undef ORCART_REALTIME_MAPPER_CONE_EXITS_SIMD
#else
#define ORCART_REALTIME_MAPPER_CONE_EXITS_SIMD
#endif

#include <hwy/highway.h>

#include "realtime/mapper/cone_clip.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

/// Edge by edge, the fraction at which it leaves the cone: with q(t) = a t^2 + 2 b t + c >= 0 inside, the
/// smallest root above 0, or the far plane if that comes first. Double precision: an edge may graze the cone.
HWY_INLINE void find_exits(const ConeNumbers& cone, const SieveScratch& corner, ConeExits& exits) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> d32;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0), far = hn::Set(d, double{cone.far_mm});
  const auto tangent2 = hn::Set(d, double{cone.tangent} * cone.tangent);
  for (std::size_t i = 0; i < exits.count; i += hn::Lanes(d)) {
    const auto from = hn::Load(di, exits.from.data() + i), to = hn::Load(di, exits.to.data() + i);
    const auto place = [&](const float* of, auto which)
                           HWY_ATTR { return hn::PromoteTo(d, hn::GatherIndex(d32, of, which)); };
    const auto x = place(corner.x.data(), from), y = place(corner.y.data(), from),
               z = place(corner.z.data(), from);
    const auto dx = hn::Sub(place(corner.x.data(), to), x), dy = hn::Sub(place(corner.y.data(), to), y),
               dz = hn::Sub(place(corner.z.data(), to), z);
    const auto wide = hn::Mul(tangent2, dz);
    const auto a = hn::NegMulAdd(dx, dx, hn::NegMulAdd(dy, dy, hn::Mul(wide, dz)));
    const auto b = hn::NegMulAdd(x, dx, hn::NegMulAdd(y, dy, hn::Mul(wide, z)));
    const auto c = hn::Max(hn::NegMulAdd(x, x, hn::NegMulAdd(y, y, hn::Mul(hn::Mul(tangent2, z), z))), zero);
    const auto under_root = hn::NegMulAdd(a, c, hn::Mul(b, b));
    const auto root = hn::Sqrt(hn::Max(under_root, zero));
    const auto falls = hn::Le(b, zero);
    const auto above = hn::IfThenElse(falls, c, hn::Add(b, root));
    const auto below = hn::IfThenElse(falls, hn::Sub(root, b), hn::Neg(a));
    const auto leaves = hn::And(hn::Gt(below, zero), hn::Ge(under_root, zero));
    auto t = hn::IfThenElse(leaves, hn::Div(above, hn::IfThenElse(leaves, below, one)), one);
    const auto deep = hn::Gt(hn::Add(z, dz), far);
    t = hn::Min(t, hn::IfThenElse(deep, hn::Div(hn::Sub(far, z), hn::IfThenElse(deep, dz, one)), one));
    hn::Store(hn::DemoteTo(d32, hn::Max(t, zero)), d32, exits.fraction.data() + i);
  }
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
