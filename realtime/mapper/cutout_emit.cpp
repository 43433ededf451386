// Writes a cutout's vertices, texture coordinates and triangles, for the processor it runs on.
#include "realtime/mapper/cutout_emit.hpp"

#include <algorithm>

#include "realtime/mapper/cone_clip.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "realtime/mapper/cutout_emit.cpp"
#include <hwy/foreach_target.h>

#include "realtime/geometry/cone_walk_simd.hpp"
#include "realtime/mapper/cone_exits_simd.hpp"
#include "realtime/mapper/cone_sieve_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The slot as bare pointers.
struct Slot {
  float *x, *y, *z, *s, *t;
  std::uint32_t* corners;
  std::uint32_t vertices = 0, triangles = 0, with_corner = 0, uncut = 0;
  std::uint32_t max_vertices, max_triangles;
};

HWY_INLINE Slot slot_of(CutoutMesh& mesh) {
  return {.x = mesh.x_mm.data(),
          .y = mesh.y_mm.data(),
          .z = mesh.z_mm.data(),
          .s = mesh.s.data(),
          .t = mesh.t.data(),
          .corners = reinterpret_cast<std::uint32_t*>(mesh.corners.data()),  // of all, not of the first one
          .max_vertices = static_cast<std::uint32_t>(mesh.x_mm.size() - kEmitPadding),
          .max_triangles = static_cast<std::uint32_t>(mesh.corners.size() - kEmitPadding)};
}

/// The paper's texture coordinates of vertices: s across C's x, t against C's y.
class TextureMap {
 public:
  static constexpr hn::CappedTag<float, 16> d{};
  using V = hn::Vec<decltype(d)>;

  TextureMap(const ConeNumbers& cone, const CutoutProgress& progress)
      : cone_(cone), s_per_mm_(progress.s_per_mm), t_per_mm_(progress.t_per_mm) {}
  HWY_INLINE void store(V x, V y, V z, float* s, float* t) const {
    const auto& r = cone_.R_CM;
    const V dx = hn::Sub(x, hn::Set(d, cone_.apex_mm[0])), dy = hn::Sub(y, hn::Set(d, cone_.apex_mm[1])),
            dz = hn::Sub(z, hn::Set(d, cone_.apex_mm[2])), half = hn::Set(d, 0.5F);
    const auto along = [&](std::size_t row, float per_mm) HWY_ATTR {
      return hn::MulAdd(hn::Set(d, r[row] * per_mm), dx,
                        hn::MulAdd(hn::Set(d, r[row + 1] * per_mm), dy,
                                   hn::MulAdd(hn::Set(d, r[row + 2] * per_mm), dz, half)));
    };
    hn::StoreU(along(0, s_per_mm_), d, s);
    hn::StoreU(along(3, -t_per_mm_), d, t);
  }

 private:
  const ConeNumbers& cone_;
  float s_per_mm_, t_per_mm_;
};

/// Copies `count` vertices from `first` on and maps them.
HWY_INLINE void emit_vertices(const ClusterTree::Arrays& tree, std::size_t first, std::size_t count,
                              const TextureMap& map, Slot& slot) {
  constexpr auto d = TextureMap::d;
  const std::size_t to = slot.vertices;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, tree.x + first + i), y = hn::LoadU(d, tree.y + first + i),
               z = hn::LoadU(d, tree.z + first + i);
    hn::StoreU(x, d, slot.x + to + i);
    hn::StoreU(y, d, slot.y + to + i);
    hn::StoreU(z, d, slot.z + to + i);
    map.store(x, y, z, slot.s + to + i, slot.t + to + i);
  }
  slot.vertices += static_cast<std::uint32_t>(count);
}

/// The vertices where edges leave the cone, behind the cluster's own, which begin at `base`.
HWY_INLINE void emit_exits(const ConeExits& exits, const TextureMap& map, std::uint32_t base, Slot& slot) {
  constexpr auto d = TextureMap::d;
  const hn::RebindToSigned<std::remove_const_t<decltype(d)>> di;
  const std::size_t to = slot.vertices;
  for (std::size_t i = 0; i < exits.count; i += hn::Lanes(d)) {
    const auto from = hn::Load(di, exits.from.data() + i), until = hn::Load(di, exits.to.data() + i);
    const auto fraction = hn::Load(d, exits.fraction.data() + i);
    const auto between = [&](float* coordinate) HWY_ATTR {
      const auto inner = hn::GatherIndex(d, coordinate + base, from);
      const auto outer = hn::GatherIndex(d, coordinate + base, until);
      const auto at = hn::MulAdd(fraction, hn::Sub(outer, inner), inner);
      hn::StoreU(at, d, coordinate + to + i);
      return at;
    };
    const auto x = between(slot.x), y = between(slot.y), z = between(slot.z);
    map.store(x, y, z, slot.s + to + i, slot.t + to + i);
  }
  slot.vertices += exits.count;
}

/// All triangles of a cluster whose vertices begin at `base` in the slot.
HWY_INLINE void emit_all(const std::uint8_t* corners, std::uint32_t count, std::uint32_t base, Slot& slot) {
  const hn::CappedTag<std::uint32_t, 16> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const auto offset = hn::Set(d, base);
  std::uint32_t* to = slot.corners + std::size_t{3} * slot.triangles;
  for (std::size_t i = 0; i < std::size_t{3} * count; i += hn::Lanes(d))
    hn::StoreU(hn::Add(hn::PromoteTo(d, hn::LoadU(d8, corners + i)), offset), d, to + i);
  slot.triangles += count;
}

/// Those of them whose bit is set.
HWY_INLINE void emit_some(const std::uint8_t* corners, std::uint64_t which, std::uint32_t base, Slot& slot) {
  const hn::CappedTag<std::uint32_t, 4> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const auto offset = hn::Set(d, base);
  std::uint32_t* to = slot.corners + std::size_t{3} * slot.triangles;
  for (; which != 0; which &= which - 1, to += 3) {
    const auto i = static_cast<std::size_t>(__builtin_ctzll(which));
    hn::StoreU(hn::Add(hn::PromoteTo(d, hn::LoadU(d8, corners + 3 * i)), offset), d, to);
  }
  slot.triangles = static_cast<std::uint32_t>((to - slot.corners) / 3);
}

/// One vertex of a polygon: a corner that is in the slot already, or a new one on an edge.
HWY_INLINE std::uint32_t clip_vertex(const ClipPoint& point, const std::uint8_t* corners, std::uint32_t base,
                                     Slot& slot) {
  const std::uint32_t from = base + corners[point.from], to = base + corners[point.to];
  if (from == to) return from;
  const std::uint32_t at = slot.vertices++;
  for (float* each : {slot.x, slot.y, slot.z, slot.s, slot.t})
    each[at] = each[from] + point.fraction * (each[to] - each[from]);
  return at;
}

HWY_INLINE void emit_clipped(const std::uint8_t* corners, const ConeNumbers& cone, bool outer_edges,
                             const SieveScratch& scratch, std::uint32_t base, Slot& slot) {
  ClipTriangle triangle;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint8_t at = corners[c];
    triangle.corner[c] = {scratch.x[at], scratch.y[at], scratch.z[at]};
    triangle.inside[c] = (scratch.notes[at] & kNoteInside) != 0;
  }
  const ClipPolygon polygon = clip_to_cone(cone, triangle, outer_edges);
  if (polygon.size == 0) {  // the axis pierces it: the cone's section is an ellipse within
    ++slot.uncut;
    emit_some(corners, 1, base, slot);
    return;
  }
  std::uint32_t vertex[6] = {};
  for (std::uint32_t i = 0; i < polygon.size; ++i)
    vertex[i] = clip_vertex(polygon.point[i], corners, base, slot);
  for (std::uint32_t i = 2; i < polygon.size; ++i) {
    std::uint32_t* to = slot.corners + std::size_t{3} * slot.triangles++;
    to[0] = vertex[0];
    to[1] = vertex[i - 1];
    to[2] = vertex[i];
  }
}

/// Corners of a triangle, in its own order, so that those in the cone come first.
struct Turned {
  std::uint8_t first, second, third;
};
constexpr Turned kTurned[8] = {{0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {0, 1, 2},
                               {2, 0, 1}, {2, 0, 1}, {1, 2, 0}, {0, 1, 2}};

/// Whether an edge between two corners outside stays out of the cone: q(t) = a t^2 + 2 b t + c is below zero
/// at both ends and at its peak. False also where it cannot be told so.
HWY_INLINE bool stays_outside(const ConeNumbers& cone, const SieveScratch& corner, std::size_t from,
                              std::size_t to) {
  const double tangent2 = double{cone.tangent} * cone.tangent;
  const double x = corner.x[from], y = corner.y[from], z = corner.z[from];
  const double dx = corner.x[to] - x, dy = corner.y[to] - y, dz = corner.z[to] - z;
  const double a = tangent2 * dz * dz - dx * dx - dy * dy;
  const double b = tangent2 * z * dz - x * dx - y * dy;
  const double c = tangent2 * z * z - x * x - y * y;
  const bool peaks_between = b > 0 && a + b < 0;
  return c < 0 && a + 2 * b + c < 0 && (!peaks_between || b * b < a * c);
}

/// Triangles with one or two corners in the cone: two edges of each leave it, and what is inside is a
/// triangle or two. Those with one corner whose outer edge may dip into the cone are left to emit_clipped
/// where `outer_edges` are asked for; returns them, and those with no corner in it.
HWY_INLINE std::uint64_t emit_cut(const std::uint8_t* corners, const ConeNumbers& cone, std::uint64_t cut,
                                  bool outer_edges, const TextureMap& map, std::uint32_t base,
                                  CutoutProgress& progress, Slot& slot) {
  const SieveScratch& scratch = progress.scratch;
  ConeExits& exits = progress.exits;
  exits.count = 0;
  std::uint64_t left = 0;
  const std::uint32_t new_vertices = slot.vertices;
  std::uint32_t* to = slot.corners + std::size_t{3} * slot.triangles;
  for (; cut != 0; cut &= cut - 1) {
    const std::uint8_t* corner = corners + 3 * static_cast<std::size_t>(__builtin_ctzll(cut));
    const std::uint32_t inside = (scratch.notes[corner[0]] & kNoteInside) |
                                 (scratch.notes[corner[1]] & kNoteInside) << 1 |
                                 (scratch.notes[corner[2]] & kNoteInside) << 2;
    const bool two = (inside & (inside - 1)) != 0;
    const Turned& turned = kTurned[inside];
    const std::uint32_t a = corner[turned.first], b = corner[turned.second], c = corner[turned.third];
    if (inside == 0 || (outer_edges && !two && !stays_outside(cone, scratch, b, c))) {
      left |= cut & -cut;
      continue;
    }
    const std::uint32_t leaving = new_vertices + exits.count, coming = leaving + 1;
    exits.from[exits.count] = static_cast<std::int32_t>(two ? b : a);
    exits.to[exits.count++] = static_cast<std::int32_t>(two ? c : b);
    exits.from[exits.count] = static_cast<std::int32_t>(a);
    exits.to[exits.count++] = static_cast<std::int32_t>(c);
    to[0] = base + a;
    to[1] = leaving;
    to[2] = coming;
    to[3] = base + a;  // kept only where two corners are in
    to[4] = base + b;
    to[5] = leaving;
    to += two ? 6 : 3;
  }
  if (exits.count == 0) return left;
  slot.triangles = static_cast<std::uint32_t>((to - slot.corners) / 3);
  for (std::size_t i = exits.count; i < exits.count + 16; ++i) exits.from[i] = exits.to[i] = 0;
  find_exits(cone, scratch, exits);
  emit_exits(exits, map, base, slot);
  return left;
}

HWY_INLINE void emit_crossing(const ClusterTree::Arrays& tree, std::uint32_t cluster, std::uint32_t count,
                              CutoutProgress& progress, Slot& slot) {
  const ConeNumbers& cone = progress.walk.cone();
  const std::uint8_t* corners = tree.corners + 3 * ClusterTree::kMaxTriangles * cluster;
  const VertexNotes notes = note_vertices(tree, cluster, cone, progress.scratch);
  const bool touching = progress.rule == CutoutRule::touching;
  if (notes.all_beyond || (notes.none_inside && !touching)) return;
  const TextureMap map(cone, progress);
  const std::uint32_t base = slot.vertices;
  const std::size_t first = tree.first_vertex[cluster], vertices = tree.first_vertex[cluster + 1] - first;
  if (notes.all_inside) {
    emit_vertices(tree, first, vertices, map, slot);
    emit_all(corners, count, base, slot);
    slot.with_corner += count;
    return;
  }
  const SieveAnswer answer = sieve_triangles(tree, cluster, count, cone, touching, progress.scratch);
  if (answer.meets == 0) return;
  slot.with_corner += static_cast<std::uint32_t>(__builtin_popcountll(answer.with_corner));
  emit_vertices(tree, first, vertices, map, slot);
  if (progress.form == CutoutForm::whole) {
    emit_some(corners, answer.meets, base, slot);
    return;
  }
  emit_some(corners, answer.whole, base, slot);
  std::uint64_t left = answer.meets & ~answer.whole;
  for (left = emit_cut(corners, cone, left, touching, map, base, progress, slot); left != 0; left &= left - 1)
    emit_clipped(corners + 3 * static_cast<std::size_t>(__builtin_ctzll(left)), cone, touching,
                 progress.scratch, base, slot);
}

/// The clusters of a run that lies inside, as many as there is room for.
HWY_INLINE void emit_inside(const ClusterTree::Arrays& tree, CutoutProgress& progress, Slot& slot) {
  constexpr auto kFull = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  const std::uint32_t first = progress.run.first, base = slot.vertices;
  std::uint32_t end = first;
  while (end < progress.run.end && slot.triangles + (end + 1 - first) * kFull <= slot.max_triangles &&
         base + (tree.first_vertex[end + 1] - tree.first_vertex[first]) <= slot.max_vertices)
    ++end;
  const std::uint32_t first_vertex = tree.first_vertex[first];
  emit_vertices(tree, first_vertex, tree.first_vertex[end] - first_vertex,
                TextureMap(progress.walk.cone(), progress), slot);
  for (std::uint32_t c = first; c < end; ++c) {
    const std::uint32_t count = std::min(kFull, tree.triangle_count - c * kFull);
    emit_all(tree.corners + std::size_t{3} * kFull * c, count, base + tree.first_vertex[c] - first_vertex,
             slot);
    slot.with_corner += count;
  }
  progress.run.first = end;
}

bool emit_into_mesh(const ClusterTree::Arrays& tree, CutoutProgress& progress, CutoutMesh& mesh) {
  constexpr auto kFull = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  const bool clip = progress.form == CutoutForm::clip;
  const auto triangles =
      static_cast<std::uint32_t>(clip ? kClippedClusterTriangles : ClusterTree::kMaxTriangles);
  const auto vertices =
      static_cast<std::uint32_t>(clip ? kClippedClusterVertices : ClusterTree::kMaxVertices);
  Slot slot = slot_of(mesh);
  bool done = false;
  ClusterRun& run = progress.run;
  for (;;) {  // bound: the walk's clusters and the slot's room
    if (run.first == run.end && !next_run(tree.nodes, progress.walk.cone(), progress.walk.frames(), run)) {
      run = {};
      done = true;
      break;
    }
    if (slot.triangles + triangles > slot.max_triangles || slot.vertices + vertices > slot.max_vertices)
      break;
    if (run.inside) {
      emit_inside(tree, progress, slot);
    } else {
      emit_crossing(tree, run.first, std::min(kFull, tree.triangle_count - run.first * kFull), progress,
                    slot);
      ++run.first;
    }
  }
  mesh.vertices = slot.vertices;
  mesh.triangles = slot.triangles;
  mesh.with_corner = slot.with_corner;
  mesh.uncut = slot.uncut;
  return done;
}

/// Sets the bits of clusters [first, end).
HWY_INLINE void mark(std::uint64_t* hit, std::uint32_t first, std::uint32_t end) {
  for (std::uint32_t at = first; at < end;) {
    const std::uint32_t bit = at % 64, length = std::min(64 - bit, end - at);
    hit[at / 64] |= ~std::uint64_t{0} >> (64 - length) << bit;
    at += length;
  }
}

/// A range from each bit that begins a run to the one that ends it: a branch a range, none a cluster.
HWY_INLINE void ranges_of_marks(const ClusterTree::Arrays& tree, CutoutRanges& out) {
  constexpr auto kFull = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  TriangleRange* to = out.ranges.data();
  std::uint32_t triangles = 0, first = 0;
  bool open = false;
  std::uint64_t before = 0;
  for (std::size_t word = 0; word < out.hit.size(); ++word) {
    const std::uint64_t bits = out.hit[word];
    for (std::uint64_t turns = bits ^ (bits << 1 | before); turns != 0; turns &= turns - 1) {
      const std::uint32_t cluster =
          static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(__builtin_ctzll(turns));
      const std::uint32_t at = std::min(cluster * kFull, tree.triangle_count);
      *to = {.first = first, .count = at - first};
      triangles += open ? at - first : 0;
      to += open ? 1 : 0;
      first = at;
      open = !open;
    }
    before = bits >> 63;
  }
  out.count = static_cast<std::uint32_t>(to - out.ranges.data());
  out.triangles = triangles;
}

/// At most a range a cluster. A node whose places are clusters is not entered: its hits are eight bits of the
/// marks.
void collect_into_ranges(const ClusterTree::Arrays& tree, ConeWalk& walk, CutoutRanges& out) {
  const ConeNumbers& cone = walk.cone();
  ConeWalkFrames& frames = walk.frames();
  std::uint64_t* hit = out.hit.data();
  std::fill(out.hit.begin(), out.hit.end(), std::uint64_t{0});
  std::size_t place = 0;
  while (const ConeWalkFrames::Frame* frame = next_place(frames, place)) {
    const ClusterTree::Node& node = tree.nodes[frame->node];
    const std::uint32_t first = node.cluster[place], end = node.cluster[place + 1];
    if ((frame->inside >> place & 1U) != 0 || end - first == 1) {
      mark(hit, first, end);
      continue;
    }
    const ClusterTree::Node& child = tree.nodes[node.child[place]];
    if (is_lowest(child))  // which begins at a multiple of eight clusters
      hit[first / 64] |= std::uint64_t{meets_of(child, cone, nullptr).hit} << first % 64;
    else
      enter_node<false>(tree.nodes, node.child[place], cone, false, frames);
  }
  ranges_of_marks(tree, out);
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

HWY_EXPORT(emit_into_mesh);
HWY_EXPORT(collect_into_ranges);

bool emit_cutout(const ClusterTree& tree, CutoutProgress& progress, CutoutMesh& mesh) noexcept {
  return HWY_DYNAMIC_DISPATCH(emit_into_mesh)(tree.arrays(), progress, mesh);
}

void collect_ranges(const ClusterTree& tree, ConeWalk& walk, CutoutRanges& ranges) noexcept {
  HWY_DYNAMIC_DISPATCH(collect_into_ranges)(tree.arrays(), walk, ranges);
}

}  // namespace orcart
#endif
