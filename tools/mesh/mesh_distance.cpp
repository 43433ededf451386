// A grid of cells holds the triangles; a point looks through shells of cells until no nearer one can come.
#include "tools/mesh/mesh_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

namespace orcart {

namespace {

using Eigen::Vector3f;
using Cell = std::array<int, 3>;

/// Squared distance of a point to a triangle (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
float squared_distance(const Vector3f& p, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Vector3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Vector3f bp = p - b;
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const Vector3f cp = p - c;
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).squaredNorm();
  const float sum = va + vb + vc;
  return (ap - vb / sum * ab - vc / sum * ac).squaredNorm();
}

class TriangleGrid {
 public:
  explicit TriangleGrid(const TriangleMesh& mesh) : mesh_(mesh) {
    low_ = mesh.vertices_mm[mesh.triangles.front()[0]];
    Vector3f high = low_;
    double edges_mm = 0;
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t v : t) {
        low_ = low_.cwiseMin(mesh.vertices_mm[v]);
        high = high.cwiseMax(mesh.vertices_mm[v]);
      }
      edges_mm += static_cast<double>((mesh.vertices_mm[t[1]] - mesh.vertices_mm[t[0]]).norm());
    }
    const float mean_edge_mm = static_cast<float>(edges_mm / static_cast<double>(mesh.triangles.size()));
    const float room_mm = (high - low_).maxCoeff();
    cell_mm_ = std::max({mean_edge_mm, room_mm / 256, 1e-3F});
    for (int axis = 0; axis < 3; ++axis)
      size_[static_cast<std::size_t>(axis)] = static_cast<int>((high - low_)[axis] / cell_mm_) + 1;
    fill();
  }

  float distance_mm(const Vector3f& p) const {
    const Cell at = cell_of(p);
    float best = std::numeric_limits<float>::infinity();
    const int most = std::max({size_[0], size_[1], size_[2]}) + 1;
    // A point outside the grid starts from the nearest cell; the slack is how far that cell's centre is off.
    const float slack = (p - p.cwiseMax(low_).cwiseMin(low_ + extent())).norm();
    for (int shell = 0; shell <= most; ++shell) {
      if (std::sqrt(best) < (static_cast<float>(shell) - 1) * cell_mm_ - slack) break;
      visit_shell(at, shell, p, best);
    }
    return std::sqrt(best);
  }

 private:
  Vector3f extent() const {
    return cell_mm_ *
           Vector3f(static_cast<float>(size_[0]), static_cast<float>(size_[1]), static_cast<float>(size_[2]));
  }
  Cell cell_of(const Vector3f& p) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] = std::clamp(static_cast<int>((p - low_)[axis] / cell_mm_), 0,
                                                        size_[static_cast<std::size_t>(axis)] - 1);
    return cell;
  }
  std::size_t index_of(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size_[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(k));
  }

  template <class Visit>
  void for_cells_of(std::uint32_t t, Visit visit) const {
    const auto& corners = mesh_.triangles[t];
    const Vector3f &a = mesh_.vertices_mm[corners[0]], &b = mesh_.vertices_mm[corners[1]],
                   &c = mesh_.vertices_mm[corners[2]];
    const Cell first = cell_of(a.cwiseMin(b).cwiseMin(c)), last = cell_of(a.cwiseMax(b).cwiseMax(c));
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int i = first[0]; i <= last[0]; ++i) visit(index_of(i, j, k));
  }

  void fill() {
    begins_.assign(index_of(size_[0] - 1, size_[1] - 1, size_[2] - 1) + 2, 0);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for_cells_of(t, [&](std::size_t cell) { ++begins_[cell + 1]; });
    for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
    held_.resize(begins_.back());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for_cells_of(t, [&](std::size_t cell) { held_[next[cell]++] = t; });
  }

  void visit_shell(const Cell& at, int shell, const Vector3f& p, float& best) const {
    for (int k = std::max(0, at[2] - shell); k <= std::min(size_[2] - 1, at[2] + shell); ++k)
      for (int j = std::max(0, at[1] - shell); j <= std::min(size_[1] - 1, at[1] + shell); ++j) {
        const bool whole_row = std::abs(k - at[2]) == shell || std::abs(j - at[1]) == shell;
        const int step = whole_row || shell == 0 ? 1 : 2 * shell;
        for (int i = at[0] - shell; i <= at[0] + shell; i += step)
          if (i >= 0 && i < size_[0]) visit_cell(index_of(i, j, k), p, best);
      }
  }

  void visit_cell(std::size_t cell, const Vector3f& p, float& best) const {
    for (std::uint32_t h = begins_[cell]; h < begins_[cell + 1]; ++h) {
      const auto& t = mesh_.triangles[held_[h]];
      best = std::min(best, squared_distance(p, mesh_.vertices_mm[t[0]], mesh_.vertices_mm[t[1]],
                                             mesh_.vertices_mm[t[2]]));
    }
  }

  const TriangleMesh& mesh_;
  Vector3f low_;
  float cell_mm_ = 1;
  Cell size_{};
  std::vector<std::uint32_t> begins_, held_;
};

}  // namespace

MeshDistance distance_to_mesh(std::span<const Vector3f> points_mm, const TriangleMesh& mesh,
                              std::size_t most_points) {
  if (points_mm.empty() || mesh.triangles.empty()) return {};
  const TriangleGrid grid(mesh);
  const std::size_t count = std::min(points_mm.size(), most_points);
  std::vector<float> distances_mm(count);
  const auto work = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      distances_mm[i] = grid.distance_mm(points_mm[i * points_mm.size() / count]);
  };
  std::thread half(work, 0, count / 2);
  work(count / 2, count);
  half.join();
  std::sort(distances_mm.begin(), distances_mm.end());
  double sum = 0;
  for (const float d : distances_mm) sum += static_cast<double>(d);
  return {.mean_mm = sum / static_cast<double>(count),
          .p95_mm = static_cast<double>(distances_mm[count * 95 / 100]),
          .max_mm = static_cast<double>(distances_mm.back()),
          .points = count};
}

}  // namespace orcart
