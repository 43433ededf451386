// Builds the cluster tree: spatial halving into clusters of 48 triangles, eight clusters to a node of the
// lowest level, eight full nodes to one above, spheres around all.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "realtime/geometry/cluster_tree.hpp"

namespace orcart {

/// Keeps the triangles in one array that splits reorder in place; a range of it is a subtree.
class ClusterTreeBuilder {
 public:
  explicit ClusterTreeBuilder(const TriangleMesh& mesh);
  Result<ClusterTree> build();

 private:
  struct Range {
    std::uint32_t first = 0, count = 0;
  };
  struct Sphere {
    Eigen::Vector3f centre;
    float radius;
  };
  struct Pending {
    Range range;
    std::uint32_t node = 0;
    std::size_t level = 0;
  };

  std::pair<Range, Range> split(Range range, std::uint32_t unit);
  std::vector<Range> split_into_eight(Range range);
  Sphere sphere_around(Range range) const;
  void add_cluster(Range range);
  void pad();
  std::uint32_t add_node();
  void fill_place(std::uint32_t node, std::size_t place, Range range, std::uint32_t child);

  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3f> centroids_;
  std::vector<std::uint32_t> order_;
  std::vector<std::int32_t> local_of_vertex_;  // -1: not in the cluster being made
  ClusterTree tree_;
};

ClusterTreeBuilder::ClusterTreeBuilder(const TriangleMesh& mesh)
    : mesh_(mesh), order_(mesh.triangles.size()), local_of_vertex_(mesh.vertices_mm.size(), -1) {
  std::iota(order_.begin(), order_.end(), 0U);
  centroids_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    centroids_.emplace_back((mesh.vertices_mm[t[0]] + mesh.vertices_mm[t[1]] + mesh.vertices_mm[t[2]]) / 3);
}

/// Two halves along the longest side of the centroids' box; the first the nearest multiple of `unit`
/// triangles.
std::pair<ClusterTreeBuilder::Range, ClusterTreeBuilder::Range> ClusterTreeBuilder::split(
    Range range, std::uint32_t unit) {
  Eigen::Vector3f low = centroids_[order_[range.first]], high = low;
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    low = low.cwiseMin(centroids_[order_[i]]);
    high = high.cwiseMax(centroids_[order_[i]]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t left = std::max(1U, (range.count + unit) / (2 * unit)) * unit;
  const auto begin = order_.begin() + range.first;
  std::nth_element(begin, begin + left, begin + range.count, [this, axis](std::uint32_t a, std::uint32_t b) {
    const float at_a = centroids_[a][axis], at_b = centroids_[b][axis];
    return at_a < at_b || (at_a == at_b && a < b);
  });
  return {{range.first, left}, {range.first + left, range.count - left}};
}

/// Splits the largest part until each fits into a subtree of the level below; full subtrees leave no places
/// empty at the bottom, where the walk spends its time. In the order of the triangles.
std::vector<ClusterTreeBuilder::Range> ClusterTreeBuilder::split_into_eight(Range range) {
  auto unit = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  while (unit * ClusterTree::kWidth < range.count) unit *= ClusterTree::kWidth;
  std::vector<Range> parts{range};
  for (;;) {
    const auto largest = std::max_element(parts.begin(), parts.end(),
                                          [](const Range& a, const Range& b) { return a.count < b.count; });
    if (largest->count <= unit) break;
    const auto [left, right] = split(*largest, unit);
    *largest = left;
    parts.push_back(right);
  }
  std::sort(parts.begin(), parts.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
  return parts;
}

/// A small sphere around a range: from the box's centre, drawn towards the farthest corner in shrinking steps
/// (Badoiu and Clarkson 2003), the radius measured at the end.
ClusterTreeBuilder::Sphere ClusterTreeBuilder::sphere_around(Range range) const {
  const auto farthest = [&](const Eigen::Vector3f& centre) {
    std::pair<float, Eigen::Vector3f> found{-1.F, centre};
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
      for (const std::uint32_t v : mesh_.triangles[order_[i]]) {
        const float d2 = (mesh_.vertices_mm[v] - centre).squaredNorm();
        if (d2 > found.first) found = {d2, mesh_.vertices_mm[v]};
      }
    return found;
  };
  Sphere best{.centre = centroids_[order_[range.first]], .radius = std::numeric_limits<float>::infinity()};
  Eigen::Vector3f centre = best.centre;
  const int steps = range.count <= 4096 ? 24 : 8;
  for (int i = 1; i <= steps; ++i) {
    const auto [d2, corner] = farthest(centre);
    if (std::sqrt(d2) < best.radius) best = {.centre = centre, .radius = std::sqrt(d2)};
    centre += (corner - centre) / static_cast<float>(i + 1);
  }
  return best;
}

void ClusterTreeBuilder::add_cluster(Range range) {
  tree_.first_vertex_.push_back(static_cast<std::uint32_t>(tree_.x_.size()));
  std::uint8_t used = 0;
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    std::array<std::uint8_t, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh_.triangles[order_[i]][c];
      if (local_of_vertex_[v] < 0) {
        local_of_vertex_[v] = used++;
        tree_.x_.push_back(mesh_.vertices_mm[v].x());
        tree_.y_.push_back(mesh_.vertices_mm[v].y());
        tree_.z_.push_back(mesh_.vertices_mm[v].z());
        tree_.vertex_ids_.push_back(v);
      }
      corners[c] = static_cast<std::uint8_t>(local_of_vertex_[v]);
    }
    tree_.corners_.push_back(corners);
    tree_.triangle_ids_.push_back(order_[i]);
  }
  for (std::size_t i = tree_.vertex_ids_.size() - used; i < tree_.vertex_ids_.size(); ++i)
    local_of_vertex_[tree_.vertex_ids_[i]] = -1;
}

/// The end of the last cluster, and what whole vectors may read beyond it.
void ClusterTreeBuilder::pad() {
  tree_.first_vertex_.push_back(static_cast<std::uint32_t>(tree_.x_.size()));
  for (std::vector<float>* coordinate : {&tree_.x_, &tree_.y_, &tree_.z_})
    coordinate->resize(coordinate->size() + ClusterTree::kPadding, 0.F);
  tree_.corners_.resize(tree_.corners_.size() + ClusterTree::kPadding);
}

std::uint32_t ClusterTreeBuilder::add_node() {
  ClusterTree::Node node{};
  node.radius.fill(-std::numeric_limits<float>::infinity());
  tree_.nodes_.push_back(node);
  return static_cast<std::uint32_t>(tree_.nodes_.size() - 1);
}

void ClusterTreeBuilder::fill_place(std::uint32_t node, std::size_t place, Range range, std::uint32_t child) {
  const Sphere sphere = sphere_around(range);
  ClusterTree::Node& at = tree_.nodes_[node];
  at.x[place] = sphere.centre.x();
  at.y[place] = sphere.centre.y();
  at.z[place] = sphere.centre.z();
  at.radius[place] = sphere.radius * 1.0001F + 1e-3F;  // queries round in single precision
  at.child[place] = child;
  constexpr auto kFull = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  at.cluster[place] = range.first / kFull;  // ranges begin at multiples of a full cluster
  for (std::size_t after = place + 1; after <= ClusterTree::kWidth; ++after)
    at.cluster[after] = (range.first + range.count + kFull - 1) / kFull;
}

Result<ClusterTree> ClusterTreeBuilder::build() {
  const auto count = static_cast<std::uint32_t>(order_.size());
  std::vector<Pending> pending{{.range = {0, count}, .node = add_node(), .level = 1}};
  while (!pending.empty()) {
    const Pending at = pending.back();
    pending.pop_back();
    if (at.level > ClusterTree::kMaxLevels)
      return fail("the surface has too many triangles for the cluster tree");
    const std::vector<Range> parts = split_into_eight(at.range);
    for (std::size_t place = 0; place < parts.size(); ++place) {
      const bool leaf = parts[place].count <= ClusterTree::kMaxTriangles;
      const std::uint32_t child = leaf ? 0 : add_node();
      fill_place(at.node, place, parts[place], child);
      if (!leaf) pending.push_back({.range = parts[place], .node = child, .level = at.level + 1});
    }
  }
  constexpr auto kFull = static_cast<std::uint32_t>(ClusterTree::kMaxTriangles);
  for (std::uint32_t first = 0; first < count; first += kFull)
    add_cluster({.first = first, .count = std::min(kFull, count - first)});
  tree_.triangle_count_ = count;
  pad();
  return std::move(tree_);
}

Result<ClusterTree> ClusterTree::create(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return fail("the surface has no triangles");
  if (mesh.triangles.size() >= (1U << 30))
    return fail("the surface has more triangles than the cart can index (2^30)");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      if (v >= mesh.vertices_mm.size() || !mesh.vertices_mm[v].allFinite())
        return fail("a triangle names vertex " + std::to_string(v) + ", which is missing or not a number");
  return ClusterTreeBuilder(mesh).build();
}

}  // namespace orcart
