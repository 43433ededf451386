// Quadric edge collapse over an indexed mesh, with a heap of edges whose stale entries are skipped.
#include "tools/mesh/decimation.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace orcart {

namespace {

using Eigen::Vector3d;

/// The sum of squared distances to planes: p'Ap + 2 b'p + c.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double c = 0;

  void add_plane(const Vector3d& normal, double offset, double weight) {
    a += weight * normal * normal.transpose();
    b += weight * offset * normal;
    c += weight * offset * offset;
  }
  Quadric operator+(const Quadric& other) const { return {a + other.a, b + other.b, c + other.c}; }
  double at(const Vector3d& p) const { return std::max(0.0, p.dot(a * p) + 2 * b.dot(p) + c); }
};

struct Collapse {
  double cost = 0;
  std::uint32_t keep = 0, drop = 0;
  std::uint32_t keep_age = 0, drop_age = 0;  ///< when it was weighed; older than the vertex is stale
  bool operator>(const Collapse& other) const {
    return std::tie(cost, keep, drop) > std::tie(other.cost, other.keep, other.drop);
  }
};

class Decimator {
 public:
  explicit Decimator(const TriangleMesh& mesh)
      : triangles_(mesh.triangles), alive_(mesh.triangles.size(), true), left_(mesh.triangles.size()) {
    for (const auto& vertex : mesh.vertices_mm) places_.push_back(vertex.cast<double>());
    quadrics_.resize(places_.size());
    ages_.resize(places_.size());
    around_.resize(places_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const Vector3d cross = normal_of(triangles_[t]);
      const double twice_area = cross.norm();
      const Vector3d normal = twice_area > 0 ? Vector3d(cross / twice_area) : Vector3d::Zero();
      for (const std::uint32_t vertex : triangles_[t]) {
        around_[vertex].push_back(t);
        quadrics_[vertex].add_plane(normal, -normal.dot(places_[triangles_[t][0]]), twice_area / 2);
      }
    }
    find_rims();
    for (const auto& t : triangles_)
      for (std::size_t i = 0; i < 3; ++i)
        if (t[i] < t[(i + 1) % 3]) weigh(t[i], t[(i + 1) % 3]);
  }

  void run(std::size_t target) {
    while (left_ > target && !heap_.empty()) {
      const Collapse next = heap_.top();
      heap_.pop();
      const bool fresh = ages_[next.keep] == next.keep_age && ages_[next.drop] == next.drop_age;
      if (fresh) try_collapse(next.keep, next.drop);
    }
  }

  TriangleMesh result() const {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    TriangleMesh mesh;
    std::vector<std::uint32_t> index_of(places_.size(), kUnused);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!alive_[t]) continue;
      auto& corners = mesh.triangles.emplace_back(triangles_[t]);
      for (std::uint32_t& corner : corners) {
        std::uint32_t& index = index_of[corner];
        if (index == kUnused) {
          index = static_cast<std::uint32_t>(mesh.vertices_mm.size());
          mesh.vertices_mm.push_back(places_[corner].cast<float>());
        }
        corner = index;
      }
    }
    return mesh;
  }

 private:
  /// The ends of edges without exactly two triangles stay where they are.
  void find_rims() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : triangles_)
      for (std::size_t i = 0; i < 3; ++i) edges.push_back(std::minmax({t[i], t[(i + 1) % 3]}));
    std::sort(edges.begin(), edges.end());
    on_rim_.resize(places_.size());
    for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
      while (next < edges.size() && edges[next] == edges[i]) ++next;
      if (next != i + 2) on_rim_[edges[i].first] = on_rim_[edges[i].second] = true;
    }
  }

  Vector3d normal_of(const std::array<std::uint32_t, 3>& t) const {
    return (places_[t[1]] - places_[t[0]]).cross(places_[t[2]] - places_[t[0]]);
  }

  /// Where the two ends meet with the least error; their middle where the planes do not say. At the one that
  /// is on a rim.
  Vector3d meeting_point(std::uint32_t keep, std::uint32_t drop, const Quadric& sum) const {
    if (on_rim_[keep] || on_rim_[drop]) return places_[on_rim_[keep] ? keep : drop];
    const Vector3d middle = (places_[keep] + places_[drop]) / 2;
    const double length = (places_[keep] - places_[drop]).norm();
    const double scale = sum.a.trace();
    const Eigen::Matrix3d steadied = sum.a + 1e-3 * scale * Eigen::Matrix3d::Identity();
    const Vector3d point = steadied.inverse() * (1e-3 * scale * middle - sum.b);
    return scale > 0 && (point - middle).norm() < length ? point : middle;
  }

  /// A little of the edge's length is added, so that flat parts thin out evenly.
  void weigh(std::uint32_t a, std::uint32_t b) {
    if (on_rim_[a] && on_rim_[b]) return;  // an inner edge between them would pinch the surface
    const Quadric sum = quadrics_[a] + quadrics_[b];
    const double squared_length = (places_[a] - places_[b]).squaredNorm();
    const double cost = sum.at(meeting_point(a, b, sum)) + 1e-3 * squared_length * squared_length;
    heap_.push({cost, std::min(a, b), std::max(a, b), ages_[std::min(a, b)], ages_[std::max(a, b)]});
  }

  std::vector<std::uint32_t> neighbours(std::uint32_t vertex) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : around_[vertex])
      for (const std::uint32_t corner : triangles_[t])
        if (corner != vertex) found.push_back(corner);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// Exactly the two corners opposite the edge are neighbours of both its ends.
  bool link_condition(std::uint32_t keep, std::uint32_t drop) const {
    const auto a = neighbours(keep), b = neighbours(drop);
    std::vector<std::uint32_t> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    return common.size() == 2 && a.size() + b.size() > 7;  // more than a tetrahedron is left
  }

  /// Whether moving `vertex` to `place` keeps every triangle but those with `other` facing as before, and
  /// none a sliver.
  bool keeps_facing(std::uint32_t vertex, std::uint32_t other, const Vector3d& place) const {
    for (const std::uint32_t t : around_[vertex]) {
      const auto& corners = triangles_[t];
      if (std::find(corners.begin(), corners.end(), other) != corners.end()) continue;
      std::array<Vector3d, 3> p;
      for (std::size_t i = 0; i < 3; ++i) p[i] = corners[i] == vertex ? place : places_[corners[i]];
      const Vector3d before = normal_of(corners), after = (p[1] - p[0]).cross(p[2] - p[0]);
      const double longest =
          std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
      if (after.dot(before) <= 0.3 * after.norm() * before.norm() || after.norm() < 0.08 * longest)
        return false;
    }
    return true;
  }

  void try_collapse(std::uint32_t keep, std::uint32_t drop) {
    if (on_rim_[drop]) std::swap(keep, drop);
    const Quadric sum = quadrics_[keep] + quadrics_[drop];
    const Vector3d place = meeting_point(keep, drop, sum);
    if (!link_condition(keep, drop) || !keeps_facing(keep, drop, place) || !keeps_facing(drop, keep, place))
      return;
    places_[keep] = place;
    quadrics_[keep] = sum;
    ++ages_[drop];
    for (const std::uint32_t t : std::vector(around_[drop])) {
      auto& corners = triangles_[t];
      if (std::find(corners.begin(), corners.end(), keep) != corners.end()) {
        alive_[t] = false;
        --left_;
        for (const std::uint32_t corner : corners) std::erase(around_[corner], t);
      } else {
        std::replace(corners.begin(), corners.end(), drop, keep);
        around_[keep].push_back(t);
      }
    }
    around_[drop].clear();
    ++ages_[keep];
    for (const std::uint32_t neighbour : neighbours(keep)) weigh(keep, neighbour);
  }

  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<bool> alive_;
  std::vector<bool> on_rim_;
  std::size_t left_;
  std::vector<Vector3d> places_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> ages_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::priority_queue<Collapse, std::vector<Collapse>, std::greater<>> heap_;
};

}  // namespace

TriangleMesh decimate(const TriangleMesh& mesh, std::size_t triangles) {
  if (mesh.triangles.size() <= triangles) return mesh;
  Decimator decimator(mesh);
  decimator.run(triangles);
  return decimator.result();
}

}  // namespace orcart
