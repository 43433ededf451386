// Sorts a cluster's triangles sixteen at a time, for the processor it runs on.
#include "realtime/mapper/cluster_sort.hpp"

#include <algorithm>

#include "realtime/mapper/facing.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "realtime/mapper/cluster_sort.cpp"
#include <hwy/foreach_target.h>

#include "realtime/mapper/cone_sieve_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct Vector3 {
  hn::Vec<D> x, y, z;
};

template <class D>
HWY_INLINE hn::Vec<D> dot(const Vector3<D>& a, const Vector3<D>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

template <class D>
HWY_INLINE Vector3<D> minus(const Vector3<D>& a, const Vector3<D>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <class D>
HWY_INLINE Vector3<D> cross(const Vector3<D>& a, const Vector3<D>& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

template <class D>
HWY_INLINE std::uint64_t bits_of(D d, hn::Mask<D> mask, std::size_t at) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return static_cast<std::uint64_t>(bytes[0] | bytes[1] << 8) << at;
}

struct FacingBits {
  std::uint64_t front = 0, unclear = 0;
};

/// cos(obliquity) at a point q is towards / (|n| |q|), greatest where q is nearest to the apex: a corner
/// within the reach settles it, and so does a triangle that is beyond it even by its longest edge.
template <class D>
HWY_INLINE FacingBits facing_of_lanes(D d, const Vector3<D> (&corner)[3], const SortRule& rule,
                                      std::size_t at) {
  // Edges from the corners as they are: their small differences lose nothing.
  const auto e1 = minus<D>(corner[1], corner[0]), e2 = minus<D>(corner[2], corner[0]),
             e3 = minus<D>(corner[2], corner[1]);
  const auto& apex = rule.cone.apex_mm;
  const Vector3<D> from{hn::Set(d, apex[0]), hn::Set(d, apex[1]), hn::Set(d, apex[2])};
  const Vector3<D> p[3] = {minus<D>(corner[0], from), minus<D>(corner[1], from), minus<D>(corner[2], from)};
  const auto n = cross<D>(e1, e2);
  const auto volume = dot<D>(n, p[0]);
  const auto towards = rule.seen_from == SeenFrom::outside ? hn::Neg(volume) : volume;
  const auto e1_2 = dot<D>(e1, e1), e2_2 = dot<D>(e2, e2), n2 = dot<D>(n, n);
  const auto p0 = dot<D>(p[0], p[0]), p1 = dot<D>(p[1], p[1]), p2 = dot<D>(p[2], p[2]);
  const auto most = hn::Max(p0, hn::Max(p1, p2)), least = hn::Min(p0, hn::Min(p1, p2));
  // Rounding of the volume: some units in the last place of |e1| |e2| |p|.
  const auto doubt = hn::Mul(hn::Set(d, 2e-6F), hn::Sqrt(hn::Mul(hn::Mul(e1_2, e2_2), most)));
  const auto certain = hn::Gt(hn::Abs(towards), doubt);
  const auto ahead = hn::Gt(towards, hn::Zero(d));
  // n^2 |q|^2 cos^2 <= towards^2, with room for rounding on either side.
  const auto cos2 = hn::Set(d, rule.cos_max_obliquity * rule.cos_max_obliquity);
  const auto reach = hn::Mul(towards, towards), scale = hn::Mul(n2, cos2);
  const auto longest = hn::Sqrt(hn::Max(e1_2, hn::Max(e2_2, dot<D>(e3, e3))));
  const auto nearest = hn::Max(hn::Sub(hn::Sqrt(least), longest), hn::Zero(d));
  // Where towards is 64 doubts, its square is right to 4 % and n^2 to 1 %.
  const auto steady = hn::Gt(hn::Abs(towards), hn::Mul(doubt, hn::Set(d, 64)));
  const auto within = hn::And(steady, hn::Le(hn::Mul(hn::Mul(scale, least), hn::Set(d, 1.1F)), reach));
  const auto beyond =
      hn::And(steady, hn::Gt(hn::Mul(hn::Mul(scale, hn::Mul(nearest, nearest)), hn::Set(d, 0.9F)), reach));
  const auto back = hn::AndNot(ahead, certain);
  const auto front = hn::And(hn::And(certain, ahead), within);
  const auto settled = hn::Or(back, hn::Or(front, hn::And(certain, beyond)));
  return {.front = bits_of(d, front, at), .unclear = bits_of(d, hn::Not(settled), at)};
}

HWY_INLINE std::uint64_t front_of(const ClusterTree::Arrays& tree, std::uint32_t cluster,
                                  const SortRule& rule, std::uint64_t which) {
  using D = hn::CappedTag<float, 16>;
  const D d;
  const hn::RebindToSigned<D> di;
  const hn::Rebind<std::uint8_t, D> d8;
  const std::uint8_t* corners = tree.corners + 3 * ClusterTree::kMaxTriangles * cluster;
  const std::size_t first = tree.first_vertex[cluster];
  FacingBits bits;
  for (std::size_t i = 0; i < ClusterTree::kMaxTriangles; i += hn::Lanes(d)) {
    hn::Vec<decltype(d8)> at[3];
    hn::LoadInterleaved3(d8, corners + 3 * i, at[0], at[1], at[2]);
    Vector3<D> p[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto index = hn::PromoteTo(di, at[c]);
      p[c] = {hn::GatherIndex(d, tree.x + first, index), hn::GatherIndex(d, tree.y + first, index),
              hn::GatherIndex(d, tree.z + first, index)};
    }
    const FacingBits some = facing_of_lanes<D>(d, p, rule, i);
    bits.front |= some.front;
    bits.unclear |= some.unclear;
  }
  bits.unclear &= which;
  return (bits.front & which) | (bits.unclear != 0 ? front_by_double(tree, cluster, rule, bits.unclear) : 0);
}

ClusterSorting sort_one(const ClusterTree::Arrays& tree, const ClusterVisit& visit, const SortRule& rule,
                        SieveScratch& scratch) {
  constexpr auto kFull = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  const std::uint32_t count = std::min(kFull, tree.triangle_count - visit.cluster * kFull);
  const std::uint64_t all = (std::uint64_t{1} << count) - 1;
  ClusterSorting sorting{.in_cone = all};
  if (!visit.inside) {
    const VertexNotes notes = note_vertices(tree, visit.cluster, rule.cone, scratch);
    if (notes.all_beyond) return {};
    if (!notes.all_inside)
      sorting.in_cone = sieve_triangles(tree, visit.cluster, count, rule.cone, true, scratch).meets;
  }
  sorting.front = rule.facing && sorting.in_cone != 0 ? front_of(tree, visit.cluster, rule, sorting.in_cone)
                                                      : sorting.in_cone;
  return sorting;
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

std::uint64_t front_by_double(const ClusterTree::Arrays& tree, std::uint32_t cluster, const SortRule& rule,
                              std::uint64_t unclear) noexcept {
  const std::uint8_t* corners = tree.corners + 3 * ClusterTree::kMaxTriangles * cluster;
  const std::size_t first = tree.first_vertex[cluster];
  const Eigen::Vector3f apex_mm(rule.cone.apex_mm.data());
  std::uint64_t front = 0;
  for (; unclear != 0; unclear &= unclear - 1) {
    const auto triangle = static_cast<std::size_t>(__builtin_ctzll(unclear));
    std::array<Eigen::Vector3f, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = first + corners[3 * triangle + c];
      p[c] = {tree.x[at], tree.y[at], tree.z[at]};
    }
    if (facing_of(p, apex_mm, rule.seen_from, rule.cos_max_obliquity) == Facing::front)
      front |= std::uint64_t{1} << triangle;
  }
  return front;
}

HWY_EXPORT(sort_one);

ClusterSorting sort_cluster(const ClusterTree& tree, const ClusterVisit& visit, const SortRule& rule,
                            SieveScratch& scratch) noexcept {
  return HWY_DYNAMIC_DISPATCH(sort_one)(tree.arrays(), visit, rule, scratch);
}

}  // namespace orcart
#endif
