// The sieve's vector code, compiled once for each processor target of a file that includes Highway's
// foreach_target.h; not for other files.
#if defined(ORCART_REALTIME_MAPPER_CONE_SIEVE_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_REALTIME_MAPPER_CONE_SIEVE_SIMD
#undef ORCART_REALTIME_MAPPER_CONE_SIEVE_SIMD
#else
#define ORCART_REALTIME_MAPPER_CONE_SIEVE_SIMD
#endif

#include <hwy/highway.h>

#include "realtime/mapper/cone_sieve.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

/// What a cluster's vertices have in common.
struct VertexNotes {
  bool all_inside = false, none_inside = false, all_beyond = false;
};

/// Brings a cluster's vertices to C and notes for each where it lies about the cone.
HWY_INLINE VertexNotes note_vertices(const ClusterTree::Arrays& tree, std::uint32_t cluster,
                                     const ConeNumbers& cone, SieveScratch& scratch) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::size_t first = tree.first_vertex[cluster], count = tree.first_vertex[cluster + 1] - first;
  const auto& r = cone.R_CM;
  const auto slack = hn::Set(d, 1e-3F), zero = hn::Zero(d), far = hn::Set(d, cone.far_mm);
  auto in_all = hn::Set(du, ~0U), in_any = hn::Zero(du);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto dx = hn::Sub(hn::LoadU(d, tree.x + first + i), hn::Set(d, cone.apex_mm[0]));
    const auto dy = hn::Sub(hn::LoadU(d, tree.y + first + i), hn::Set(d, cone.apex_mm[1]));
    const auto dz = hn::Sub(hn::LoadU(d, tree.z + first + i), hn::Set(d, cone.apex_mm[2]));
    const auto row = [&](std::size_t k) HWY_ATTR {
      return hn::MulAdd(hn::Set(d, r[k]), dx,
                        hn::MulAdd(hn::Set(d, r[k + 1]), dy, hn::Mul(hn::Set(d, r[k + 2]), dz)));
    };
    const auto x = row(0), y = row(3), z = row(6);
    const auto wide = hn::Mul(z, hn::Set(d, cone.tangent));
    const auto rho2 = hn::MulAdd(x, x, hn::Mul(y, y));
    const auto over = hn::NegMulAdd(wide, wide, rho2);
    const auto inside = hn::And(hn::And(hn::Ge(z, zero), hn::Le(z, far)), hn::Le(over, zero));
    const auto noted = [&](auto mask, std::uint32_t bit) HWY_ATTR {
      return hn::IfThenElseZero(hn::RebindMask(du, mask), hn::Set(du, bit));
    };
    auto notes = noted(inside, kNoteInside);
    // Planes that touch the cone along its flank, in four directions and their opposites.
    const auto diagonal = hn::Set(d, 0.70710678F);
    const auto limit = hn::Add(wide, slack), opposite = hn::Neg(limit);
    const auto u = hn::Mul(hn::Add(x, y), diagonal), v = hn::Mul(hn::Sub(x, y), diagonal);
    notes = hn::Or(notes, hn::Or(noted(hn::Gt(x, limit), 2), noted(hn::Lt(x, opposite), 4)));
    notes = hn::Or(notes, hn::Or(noted(hn::Gt(y, limit), 8), noted(hn::Lt(y, opposite), 16)));
    notes = hn::Or(notes, hn::Or(noted(hn::Gt(u, limit), 32), noted(hn::Lt(u, opposite), 64)));
    notes = hn::Or(notes, hn::Or(noted(hn::Gt(v, limit), 128), noted(hn::Lt(v, opposite), 256)));
    notes = hn::Or(
        notes, hn::Or(noted(hn::Lt(z, hn::Neg(slack)), 512), noted(hn::Gt(z, hn::Add(far, slack)), 1024)));
    hn::Store(x, d, scratch.x.data() + i);
    hn::Store(y, d, scratch.y.data() + i);
    hn::Store(z, d, scratch.z.data() + i);
    hn::Store(notes, du, scratch.notes.data() + i);
    // Within rounding of the cone's surface double precision decides: few lanes ever.
    const auto reach = hn::MulAdd(hn::MulAdd(z, z, rho2), hn::Set(d, 2e-6F), hn::Set(d, 1e-12F));
    const auto close = hn::Set(d, 1e-6F);
    const auto near_far = hn::Le(hn::Abs(hn::Sub(z, far)), hn::MulAdd(far, close, close));
    const auto near_apex = hn::Le(hn::Abs(z), close);
    const auto unclear = hn::Or(hn::Le(hn::Abs(over), reach), hn::Or(near_far, near_apex));
    if (HWY_UNLIKELY(!hn::AllFalse(d, unclear))) {
      for (std::size_t k = i; k < i + hn::Lanes(d) && k < count; ++k) {
        const bool in = point_in_cone(cone, tree.x[first + k], tree.y[first + k], tree.z[first + k]);
        scratch.notes[k] = (scratch.notes[k] & ~kNoteInside) | (in ? kNoteInside : 0);
      }
      notes = hn::Load(du, scratch.notes.data() + i);
    }
    const auto beyond_end = hn::Not(hn::FirstN(du, count - i));
    in_all = hn::And(in_all, hn::Or(notes, hn::IfThenElseZero(beyond_end, hn::Set(du, ~0U))));
    in_any = hn::Or(in_any, hn::IfThenZeroElse(beyond_end, notes));
  }
  alignas(64) std::uint32_t all_lanes[16], any_lanes[16];
  hn::Store(in_all, du, all_lanes);
  hn::Store(in_any, du, any_lanes);
  std::uint32_t all = ~0U, any = 0;
  for (std::size_t k = 0; k < hn::Lanes(du); ++k) {
    all &= all_lanes[k];
    any |= any_lanes[k];
  }
  return {.all_inside = (all & kNoteInside) != 0,
          .none_inside = (any & kNoteInside) == 0,
          .all_beyond = (all & ~kNoteInside & 0x7FFU) != 0};
}

/// The triangles of the cluster whose vertices were noted last. `touching`: those that meet the cone with no
/// corner in it are looked at one by one.
HWY_INLINE SieveAnswer sieve_triangles(const ClusterTree::Arrays& tree, std::uint32_t cluster,
                                       std::size_t count, const ConeNumbers& cone, bool touching,
                                       const SieveScratch& scratch) {
  const std::uint8_t* corners = tree.corners + 3 * ClusterTree::kMaxTriangles * cluster;
  SieveAnswer answer;
  std::uint64_t open = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = scratch.notes[corners[3 * i]], b = scratch.notes[corners[3 * i + 1]],
                        c = scratch.notes[corners[3 * i + 2]];
    const std::uint64_t any = (a | b | c) & kNoteInside, all = a & b & c;
    answer.with_corner |= any << i;
    answer.whole |= (all & kNoteInside) << i;
    open |= static_cast<std::uint64_t>((any | all) == 0 ? 1U : 0U) << i;
  }
  answer.meets = answer.with_corner;
  if (touching && open != 0) answer.meets |= meeting_of(scratch, corners, cone, open);
  return answer;
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
