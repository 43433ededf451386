// Writes a cutout's vertices, texture coordinates and triangles, for the processor it runs on.
#include "realtime/mapper/cutout_emit.hpp"

#include <algorithm>

#include "realtime/mapper/cone_clip.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "realtime/mapper/cutout_emit.cpp"
#include <hwy/foreach_target.h>

#include "realtime/geometry/cone_walk_simd.hpp"
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

/// Copies `count` vertices from `first` on and maps them: s across C's x, t against C's y.
HWY_INLINE void emit_vertices(const ClusterTree::Arrays& tree, std::size_t first, std::size_t count,
                              const ConeNumbers& cone, const CutoutProgress& progress, Slot& slot) {
  const hn::CappedTag<float, 16> d;
  const auto& r = cone.R_CM;
  const auto half = hn::Set(d, 0.5F);
  const auto s0 = hn::Set(d, r[0] * progress.s_per_mm), s1 = hn::Set(d, r[1] * progress.s_per_mm),
             s2 = hn::Set(d, r[2] * progress.s_per_mm);
  const auto t0 = hn::Set(d, -r[3] * progress.t_per_mm), t1 = hn::Set(d, -r[4] * progress.t_per_mm),
             t2 = hn::Set(d, -r[5] * progress.t_per_mm);
  const auto ax = hn::Set(d, cone.apex_mm[0]), ay = hn::Set(d, cone.apex_mm[1]),
             az = hn::Set(d, cone.apex_mm[2]);
  const std::size_t to = slot.vertices;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, tree.x + first + i), y = hn::LoadU(d, tree.y + first + i),
               z = hn::LoadU(d, tree.z + first + i);
    const auto dx = hn::Sub(x, ax), dy = hn::Sub(y, ay), dz = hn::Sub(z, az);
    hn::StoreU(x, d, slot.x + to + i);
    hn::StoreU(y, d, slot.y + to + i);
    hn::StoreU(z, d, slot.z + to + i);
    hn::StoreU(hn::MulAdd(s0, dx, hn::MulAdd(s1, dy, hn::MulAdd(s2, dz, half))), d, slot.s + to + i);
    hn::StoreU(hn::MulAdd(t0, dx, hn::MulAdd(t1, dy, hn::MulAdd(t2, dz, half))), d, slot.t + to + i);
  }
  slot.vertices += static_cast<std::uint32_t>(count);
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

HWY_INLINE void emit_crossing(const ClusterTree::Arrays& tree, std::uint32_t cluster, std::uint32_t count,
                              CutoutProgress& progress, Slot& slot) {
  const ConeNumbers& cone = progress.walk.cone();
  const std::uint8_t* corners = tree.corners + 3 * ClusterTree::kMaxTriangles * cluster;
  const VertexNotes notes = note_vertices(tree, cluster, cone, progress.scratch);
  if (notes.all_beyond) return;
  const std::uint32_t base = slot.vertices;
  const std::size_t first = tree.first_vertex[cluster], vertices = tree.first_vertex[cluster + 1] - first;
  if (notes.all_inside) {
    emit_vertices(tree, first, vertices, cone, progress, slot);
    emit_all(corners, count, base, slot);
    slot.with_corner += count;
    return;
  }
  const bool touching = progress.rule == CutoutRule::touching;
  const SieveAnswer answer = sieve_triangles(tree, cluster, count, cone, touching, progress.scratch);
  if (answer.meets == 0) return;
  slot.with_corner += static_cast<std::uint32_t>(__builtin_popcountll(answer.with_corner));
  emit_vertices(tree, first, vertices, cone, progress, slot);
  if (progress.form == CutoutForm::whole) {
    emit_some(corners, answer.meets, base, slot);
    return;
  }
  emit_some(corners, answer.whole, base, slot);
  for (std::uint64_t cut = answer.meets & ~answer.whole; cut != 0; cut &= cut - 1)
    emit_clipped(corners + 3 * static_cast<std::size_t>(__builtin_ctzll(cut)), cone, touching,
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
  emit_vertices(tree, first_vertex, tree.first_vertex[end] - first_vertex, progress.walk.cone(), progress,
                slot);
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

void collect_into_ranges(const ClusterTree::Arrays& tree, ConeWalk& walk, CutoutRanges& out) {
  constexpr auto kFull = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  TriangleRange* ranges = out.ranges.data();
  std::uint32_t count = 0, triangles = 0, open_end = ~0U;
  ClusterRun run;
  while (next_run(tree.nodes, walk.cone(), walk.frames(), run)) {  // at most a range a cluster
    const std::uint32_t first = run.first * kFull, end = std::min(run.end * kFull, tree.triangle_count);
    if (first == open_end)
      ranges[count - 1].count += end - first;
    else
      ranges[count++] = {.first = first, .count = end - first};
    open_end = end;
    triangles += end - first;
  }
  out.count = count;
  out.triangles = triangles;
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
