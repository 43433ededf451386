// One view after another: walks the clusters in the cone and sorts their triangles into the patch.
#include "realtime/mapper/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "realtime/geometry/cone_walk.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "realtime/mapper/cluster_sort.hpp"
#include "realtime/mapper/five_rays.hpp"
#include "realtime/mapper/occlusion.hpp"

namespace orcart {
namespace {

constexpr double kWidestCone_rad = 85 * 3.14159265358979 / 180;
constexpr std::uint32_t kRaysPerCluster = ClusterTree::kMaxTriangles * Occlusion::kMaxRays;

MapperLimits usable(MapperLimits limits) {
  constexpr auto kCluster = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  limits.max_triangles_per_step = std::max(limits.max_triangles_per_step, kCluster);
  limits.max_rays_per_step = std::max(limits.max_rays_per_step, kRaysPerCluster);
  return limits;
}

}  // namespace

struct Mapper::State {
  // What the surface and the scope fix.
  ClusterTree tree;
  RayScene surface;
  MapperLimits limits;
  ConeShape shape;
  FiveDirections lens_rays, rectified_rays;
  SortRule rule;  ///< its cone and `facing` are the view's
  // What one view sets.
  Occlusion occlusion;
  SieveScratch scratch{};
  Pose<M, C> X_MC{};
  TextureMode mode = TextureMode::perspective;
  FiveRays rays{};
  PaperProjection paper{};
  ViewingCone cone{};
  // How far the view has come.
  ConeWalk walk{};
  ClusterVisit waiting{};
  bool has_waiting = false, first = true, done = true;

  void start_part(CutoutPatch& patch) const noexcept;
  bool next_cluster() noexcept;
  void take_cluster(CutoutPatch& patch) noexcept;
};

void Mapper::State::start_part(CutoutPatch& patch) const noexcept {
  patch.X_MC = X_MC;
  patch.mode = mode;
  patch.rays = rays;
  patch.paper = paper;
  patch.triangles.clear();
  patch.occluders.clear();
  patch.first_part = first;
  patch.triangles_in_cone = 0;
}

/// Puts the next cluster into `waiting`, unless one waits already.
bool Mapper::State::next_cluster() noexcept {
  has_waiting = has_waiting || walk.next(tree, waiting);
  return has_waiting;
}

void Mapper::State::take_cluster(CutoutPatch& patch) noexcept {
  const ClusterSorting sorting = sort_cluster(tree, waiting, rule, scratch);
  const ClusterTree::Cluster cluster = tree.cluster(waiting.cluster);
  std::uint64_t painted = sorting.front;
  if (rule.facing && limits.test_occlusion && painted != 0)
    painted &= ~occlusion.hidden(surface, cluster, painted);
  const auto append = [&](std::vector<std::uint32_t>& list, std::uint64_t which) {
    for (; which != 0; which &= which - 1)
      list.push_back(cluster.triangle_ids[static_cast<std::size_t>(__builtin_ctzll(which))]);
  };
  append(patch.triangles, painted);
  append(patch.occluders, sorting.in_cone & ~painted);
  patch.triangles_in_cone += static_cast<std::uint32_t>(__builtin_popcountll(sorting.in_cone));
  has_waiting = false;
}

std::size_t patch_capacity(const MapperLimits& limits) {
  return usable(limits).max_triangles_per_step;
}

Mapper::Mapper(std::unique_ptr<State> state) : state_(std::move(state)) {}
Mapper::Mapper(Mapper&&) noexcept = default;
Mapper& Mapper::operator=(Mapper&&) noexcept = default;
Mapper::~Mapper() = default;

Result<Mapper> Mapper::create(const Surface& surface, SeenFrom seen_from, const ScopeModel& scope,
                              const MapperLimits& limits) {
  if (!(scope.cone_half_angle_rad > 0 && scope.cone_half_angle_rad <= kWidestCone_rad))
    return fail("the scope's cone half angle is " + std::to_string(scope.cone_half_angle_rad) +
                " rad; it must be above 0 and at most 1.48 (85 degrees)");
  if (!(scope.far_mm > 0))
    return fail("the scope's far_mm is " + std::to_string(scope.far_mm) + "; it must be above 0");
  auto tree = ClusterTree::create(surface.mesh);
  if (!tree) return tl::unexpected(tree.error());
  auto rays = RayScene::create(surface.mesh);
  if (!rays) return tl::unexpected(rays.error());
  return Mapper(std::unique_ptr<State>(new State{
      .tree = std::move(*tree),
      .surface = std::move(*rays),
      .limits = usable(limits),
      .shape = {.half_angle_rad = scope.cone_half_angle_rad, .far_mm = scope.far_mm},
      .lens_rays = lens_directions(scope),
      .rectified_rays = rectified_directions(scope),
      .rule = {.cone = {},
               .seen_from = seen_from,
               .cos_max_obliquity =
                   static_cast<float>(std::cos(std::min(limits.max_obliquity_rad, kWidestCone_rad)))},
      .occlusion = Occlusion(surface.mesh.vertices_mm.size())}));
}

void Mapper::begin(const Pose<M, C>& X_MC, TextureMode mode) noexcept {
  State& s = *state_;
  s.X_MC = X_MC;
  s.mode = mode;
  s.cone = viewing_cone(X_MC, s.shape);
  const bool paper = mode == TextureMode::paper;
  s.rays = trace_five_rays(s.surface, X_MC, paper ? s.rectified_rays : s.lens_rays, s.shape.far_mm);
  s.paper = paper ? paper_projection(X_MC, s.rays, s.shape.half_angle_rad) : PaperProjection{};
  s.rule.cone = numbers_of(s.cone);
  s.rule.facing = !paper;
  s.occlusion.begin(s.cone.apex_mm);
  s.walk = ConeWalk{};  // over before it begins, where paper mode has no centre
  if (!paper || s.paper.valid) s.walk.begin(s.tree, s.cone);
  s.has_waiting = false;
  s.first = true;
  s.done = false;
}

bool Mapper::next(CutoutPatch& patch) noexcept {
  State& s = *state_;
  if (s.done) return false;
  s.start_part(patch);
  const std::size_t room = std::min(patch.triangles.capacity(), patch.occluders.capacity());
  const std::size_t most = std::min<std::size_t>(s.limits.max_triangles_per_step, room);
  const std::uint32_t rays_before = s.occlusion.rays();
  std::size_t looked_at = 0;
  while (s.next_cluster()) {  // bound: the tree's nodes and the limits
    const std::size_t wanted = s.tree.cluster(s.waiting.cluster).corners.size();
    const std::uint32_t rays = s.occlusion.rays() - rays_before + kRaysPerCluster;
    if (looked_at + wanted > most || rays > s.limits.max_rays_per_step) break;
    looked_at += wanted;
    s.take_cluster(patch);
  }
  s.first = false;
  // A slot too small for one cluster could never get on; the view ends there instead of going round for ever.
  s.done = !s.has_waiting || looked_at == 0;
  patch.last_part = s.done;
  return true;
}

}  // namespace orcart
