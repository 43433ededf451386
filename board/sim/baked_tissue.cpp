// Mesh colours: sample (i, j) of a triangle with n steps lies at barycentric b1 = i / n, b2 = j / n.
#include "board/sim/baked_tissue.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {
namespace {

std::uint8_t coded(float value) {
  return static_cast<std::uint8_t>(255 * std::sqrt(value) + 0.5F);
}

}  // namespace

struct BakedTissue::Grid {
  int steps = 1;
  std::vector<Sample> samples;  ///< row i holds steps - i + 1 samples
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i * (steps + 1) - i * (i - 1) / 2 + j);
  }
};

BakedTissue::BakedTissue(const TriangleMesh& mesh, const LivingTissue& tissue, float texel_mm)
    : mesh_(mesh), tissue_(tissue), texel_mm_(texel_mm), grids_(mesh.triangles.size()) {}

BakedTissue::~BakedTissue() {
  for (auto& grid : grids_) delete grid.load(std::memory_order_relaxed);
}

TissueSample BakedTissue::at(const RayHit& hit) const {
  const Grid& grid = grid_of(hit.triangle);
  const float u = std::clamp(hit.b1, 0.0F, 1.0F) * static_cast<float>(grid.steps);
  const float v = std::clamp(hit.b2, 0.0F, 1.0F) * static_cast<float>(grid.steps);
  const int i = std::min(static_cast<int>(u), grid.steps - 1);
  const int j = std::min(static_cast<int>(v), grid.steps - 1 - i);
  float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
  // The lower small triangle has its right angle at (i, j), the upper one, where there is one, at (i+1, j+1).
  const bool upper = fu + fv > 1 && i + j + 2 <= grid.steps;
  const Sample& corner = grid.samples[upper ? grid.index(i + 1, j + 1) : grid.index(i, j)];
  const Sample& along_u = grid.samples[upper ? grid.index(i, j + 1) : grid.index(i + 1, j)];
  const Sample& along_v = grid.samples[upper ? grid.index(i + 1, j) : grid.index(i, j + 1)];
  if (upper) {
    fu = 1 - fu;
    fv = 1 - fv;
  }
  std::array<float, 4> s;
  for (std::size_t c = 0; c < s.size(); ++c) {
    const float at = corner[c];
    const float root = (at + fu * (along_u[c] - at) + fv * (along_v[c] - at)) / 255;
    s[c] = root * root;
  }
  return {.colour = {s[0], s[1], s[2]}, .gloss = s[3]};
}

const BakedTissue::Grid& BakedTissue::grid_of(std::uint32_t triangle) const {
  Grid* grid = grids_[triangle].load(std::memory_order_acquire);  // partner: the exchange below
  if (grid != nullptr) return *grid;
  auto fresh = bake(triangle);
  if (grids_[triangle].compare_exchange_strong(grid, fresh.get(),
                                               std::memory_order_acq_rel))  // partner: the load above
    return *fresh.release();
  return *grid;
}

std::unique_ptr<BakedTissue::Grid> BakedTissue::bake(std::uint32_t triangle) const {
  const auto& corners = mesh_.triangles[triangle];
  const Eigen::Vector3f a = mesh_.vertices_mm[corners[0]];
  const Eigen::Vector3f ab = mesh_.vertices_mm[corners[1]] - a, ac = mesh_.vertices_mm[corners[2]] - a;
  const float longest_mm = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
  auto grid = std::make_unique<Grid>();
  grid->steps = std::clamp(static_cast<int>(std::ceil(longest_mm / texel_mm_)), 1, 400);
  const float step = 1.0F / static_cast<float>(grid->steps);
  for (int i = 0; i <= grid->steps; ++i)
    for (int j = 0; j <= grid->steps - i; ++j) {
      const TissueSample s =
          tissue_sample(a + static_cast<float>(i) * step * ab + static_cast<float>(j) * step * ac, tissue_);
      grid->samples.push_back(
          {coded(s.colour.x()), coded(s.colour.y()), coded(s.colour.z()), coded(s.gloss)});
    }
  return grid;
}

}  // namespace orcart
