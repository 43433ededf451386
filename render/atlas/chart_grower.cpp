// Breadth-first growth with an occupancy grid that refuses a triangle lying over another one of the same
// chart.
#include "render/atlas/chart_grower.hpp"

#include <Eigen/Geometry>

#include "render/atlas/texel_raster.hpp"
#include "render/atlas/triangle_adjacency.hpp"

namespace orcart {
namespace {

constexpr float kCosNormalLimit = 0.64f;  // 50 degrees: the projection stretches at most 1.6-fold
constexpr std::uint32_t kNone = 0xFFFFFFFF;

class Grower {
 public:
  Grower(const TriangleMesh& mesh, double texel_mm)
      : mesh_(mesh),
        texels_per_mm_(static_cast<float>(1.0 / texel_mm)),
        neighbours_(triangle_neighbours(mesh)),
        normals_(mesh.triangles.size()),
        taken_(mesh.triangles.size(), 0),
        grid_(static_cast<std::size_t>(kGrid) * kGrid, kNone) {
    for (std::size_t t = 0; t < normals_.size(); ++t) {
      const auto& [a, b, c] = corners_of(static_cast<std::uint32_t>(t));
      normals_[t] = (b - a).cross(c - a).normalized();
      if (!normals_[t].allFinite()) normals_[t].setZero();
    }
  }

  std::vector<Chart> all() {
    std::vector<Chart> charts;
    for (std::uint32_t seed = 0; seed < taken_.size(); ++seed)
      if (!taken_[seed]) charts.push_back(grow(seed));
    return charts;
  }

 private:
  static constexpr int kGrid = 2 * kChartSizeTexels;

  std::array<Eigen::Vector3f, 3> corners_of(std::uint32_t t) const {
    const auto& i = mesh_.triangles[t];
    return {mesh_.vertices_mm[i[0]], mesh_.vertices_mm[i[1]], mesh_.vertices_mm[i[2]]};
  }

  /// The plane of a new chart: through the seed, across the mean normal of the seed and its neighbours.
  void set_plane(std::uint32_t seed) {
    Eigen::Vector3f sum = normals_[seed];
    for (const std::uint32_t n : neighbours_[seed])
      if (n != kNone && normals_[n].dot(normals_[seed]) > kCosNormalLimit) sum += normals_[n];
    normal_ = sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : Eigen::Vector3f::UnitZ();
    axis_x_ = normal_.unitOrthogonal();
    axis_y_ = normal_.cross(axis_x_);
    origin_ = corners_of(seed)[0];
  }

  FlatTriangle flat(std::uint32_t t) const {
    FlatTriangle out;
    const auto corners = corners_of(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3f d = corners[i] - origin_;
      out[i] = Eigen::Vector2f(d.dot(axis_x_), d.dot(axis_y_)) * texels_per_mm_;
    }
    return out;
  }

  /// Whether the chart stays small enough, and no texel would be covered twice.
  bool fits(const FlatTriangle& t) const {
    Eigen::Vector2f low = low_, high = high_;
    for (const auto& p : t) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    if (((high - low).array() > kChartSizeTexels - 4).any()) return false;
    bool free = true;
    visit(t,
          [&](std::size_t cell, float inside) { free = free && (grid_[cell] != chart_ || inside < 1e-4f); });
    return free;
  }

  template <class Visit>
  void visit(const FlatTriangle& t, Visit visit_cell) const {
    FlatTriangle moved = t;
    for (auto& p : moved) p += Eigen::Vector2f::Constant(kChartSizeTexels);
    for_each_texel(moved, 0, kGrid, kGrid, [&](int x, int y, float b1, float b2, float) {
      visit_cell(static_cast<std::size_t>(y) * kGrid + static_cast<std::size_t>(x),
                 std::min({b1, b2, 1 - b1 - b2}));
    });
  }

  void take(std::uint32_t t, const FlatTriangle& corners, Chart& chart) {
    taken_[t] = 1;
    for (const auto& p : corners) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    visit(corners, [&](std::size_t cell, float) { grid_[cell] = chart_; });
    chart.triangles.push_back(t);
    chart.corners_texels.push_back(corners);
  }

  Chart grow(std::uint32_t seed) {
    Chart chart;
    ++chart_;
    set_plane(seed);
    const FlatTriangle first = flat(seed);
    low_ = high_ = first[0];
    take(seed, first, chart);
    for (std::size_t next = 0; next < chart.triangles.size(); ++next) {
      for (const std::uint32_t n : neighbours_[chart.triangles[next]]) {
        if (n == kNone || taken_[n] || normals_[n].dot(normal_) < kCosNormalLimit) continue;
        const FlatTriangle corners = flat(n);
        if (fits(corners)) take(n, corners, chart);
      }
    }
    const Eigen::Vector2f first_texel =
        low_.array().floor();  // whole texels: what overlapped on the grid does so there
    for (auto& corners : chart.corners_texels)
      for (auto& p : corners) p -= first_texel;
    chart.size_texels = high_ - first_texel;
    return chart;
  }

  const TriangleMesh& mesh_;
  float texels_per_mm_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<Eigen::Vector3f> normals_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint32_t> grid_;  ///< which chart last covered a cell; so it need not be cleared
  std::uint32_t chart_ = 0;
  Eigen::Vector3f normal_, axis_x_, axis_y_, origin_;
  Eigen::Vector2f low_, high_;
};

}  // namespace

std::vector<Chart> grow_charts(const TriangleMesh& mesh, double texel_mm) {
  return Grower(mesh, texel_mm).all();
}

}  // namespace orcart
