// The walk's inner loop, compiled once for each processor target of a file that includes Highway's
// foreach_target.h; not for other files.
#if defined(ORCART_REALTIME_GEOMETRY_CONE_WALK_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef ORCART_REALTIME_GEOMETRY_CONE_WALK_SIMD
#undef ORCART_REALTIME_GEOMETRY_CONE_WALK_SIMD
#else
#define ORCART_REALTIME_GEOMETRY_CONE_WALK_SIMD
#endif

#include <hwy/highway.h>

#include "realtime/geometry/cone_walk.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

/// Which of a node's eight spheres meet the cone, and which lie inside it: a bit a place.
struct NodeMeets {
  std::uint32_t hit = 0, inside = 0;
};

/// `depth_mm`: where the centres' depths are noted, which a walk from near to far asks for; else null.
HWY_INLINE NodeMeets meets_of(const ClusterTree::Node& node, const ConeNumbers& cone, float* depth_mm) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<float, ClusterTree::kWidth> d;
  const auto& r = cone.R_CM;
  NodeMeets meets;
  for (std::size_t i = 0; i < ClusterTree::kWidth; i += hn::Lanes(d)) {
    const auto dx = hn::Sub(hn::LoadU(d, &node.x[i]), hn::Set(d, cone.apex_mm[0]));
    const auto dy = hn::Sub(hn::LoadU(d, &node.y[i]), hn::Set(d, cone.apex_mm[1]));
    const auto dz = hn::Sub(hn::LoadU(d, &node.z[i]), hn::Set(d, cone.apex_mm[2]));
    const auto radius = hn::LoadU(d, &node.radius[i]);
    const auto row = [&](std::size_t k) HWY_ATTR {
      return hn::MulAdd(hn::Set(d, r[k]), dx,
                        hn::MulAdd(hn::Set(d, r[k + 1]), dy, hn::Mul(hn::Set(d, r[k + 2]), dz)));
    };
    const auto x = row(0), y = row(3), z = row(6);
    // rho cos - z sin is the distance from the cone's flank, negative inside; its two terms are compared
    // squared.
    const auto across = hn::Mul(hn::MulAdd(x, x, hn::Mul(y, y)), hn::Set(d, cone.cosine * cone.cosine));
    const auto rise = hn::Mul(z, hn::Set(d, cone.sine));
    const auto outer = hn::Add(rise, radius), inner = hn::Sub(rise, radius);
    const auto zero = hn::Zero(d), far = hn::Set(d, cone.far_mm);
    const auto near_side = hn::Sub(z, radius), far_side = hn::Add(z, radius);
    const auto hit = hn::And(hn::And(hn::Ge(outer, zero), hn::Le(across, hn::Mul(outer, outer))),
                             hn::And(hn::Le(near_side, far), hn::Ge(far_side, zero)));
    const auto inside =
        hn::And(hn::And(hn::Gt(inner, zero), hn::Lt(across, hn::Mul(inner, inner))), hn::Lt(far_side, far));
    std::uint8_t hit_bits[8] = {}, inside_bits[8] = {};
    hn::StoreMaskBits(d, hit, hit_bits);
    hn::StoreMaskBits(d, inside, inside_bits);
    meets.hit |= static_cast<std::uint32_t>(hit_bits[0]) << i;
    meets.inside |= static_cast<std::uint32_t>(inside_bits[0]) << i;
    if (depth_mm != nullptr) hn::StoreU(z, d, depth_mm + i);
  }
  return meets;
}

/// `all_inside`: the node lies inside as a whole.
template <bool kWithDepths>
HWY_INLINE void enter_node(const ClusterTree::Node* nodes, std::uint32_t index, const ConeNumbers& cone,
                           bool all_inside, ConeWalkFrames& walk) {
  ConeWalkFrames::Frame& frame = walk.frame[walk.size++];
  frame.node = index;
  const NodeMeets meets = meets_of(nodes[index], cone, kWithDepths ? frame.depth_mm.data() : nullptr);
  frame.hit = meets.hit;
  frame.inside = all_inside ? 0xFF : meets.inside;
}

/// Whether each of its places is one cluster.
HWY_INLINE bool is_lowest(const ClusterTree::Node& node) {
  return node.cluster[ClusterTree::kWidth] - node.cluster[0] <= ClusterTree::kWidth;
}

/// The next place of the nodes that were entered, in the tree's order, and its node's frame; null when there
/// is none.
HWY_INLINE const ConeWalkFrames::Frame* next_place(ConeWalkFrames& walk, std::size_t& place) {
  while (walk.size > 0) {
    ConeWalkFrames::Frame& frame = walk.frame[walk.size - 1];
    if (frame.hit == 0) {
      --walk.size;
      continue;
    }
    place = static_cast<std::size_t>(__builtin_ctz(frame.hit));
    frame.hit &= frame.hit - 1;
    return &frame;
  }
  return nullptr;
}

/// The next run in the tree's order. Bound: a node is entered once, a place looked at once.
HWY_INLINE bool next_run(const ClusterTree::Node* nodes, const ConeNumbers& cone, ConeWalkFrames& walk,
                         ClusterRun& run) {
  std::size_t place = 0;
  while (const ConeWalkFrames::Frame* frame = next_place(walk, place)) {
    const ClusterTree::Node& node = nodes[frame->node];
    run.first = node.cluster[place];
    run.end = node.cluster[place + 1];
    run.inside = (frame->inside >> place & 1U) != 0;
    if (run.inside || run.end - run.first == 1) return true;
    enter_node<false>(nodes, node.child[place], cone, false, walk);
  }
  return false;
}

/// The next cluster, the nearest child of each node first.
HWY_INLINE bool next_visit(const ClusterTree::Node* nodes, const ConeNumbers& cone, ConeWalkFrames& walk,
                           ClusterVisit& visit) {
  while (walk.size > 0) {
    ConeWalkFrames::Frame& frame = walk.frame[walk.size - 1];
    if (frame.hit == 0) {
      --walk.size;
      continue;
    }
    auto place = static_cast<std::size_t>(__builtin_ctz(frame.hit));
    for (std::uint32_t rest = frame.hit & (frame.hit - 1); rest != 0; rest &= rest - 1) {
      const auto other = static_cast<std::size_t>(__builtin_ctz(rest));
      if (frame.depth_mm[other] < frame.depth_mm[place]) place = other;
    }
    frame.hit &= ~(1U << place);
    const ClusterTree::Node& node = nodes[frame.node];
    const bool inside = (frame.inside >> place & 1U) != 0;
    if (node.cluster[place + 1] - node.cluster[place] == 1) {
      visit = {.cluster = node.cluster[place], .inside = inside};
      return true;
    }
    enter_node<true>(nodes, node.child[place], cone, inside, walk);
  }
  return false;
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
