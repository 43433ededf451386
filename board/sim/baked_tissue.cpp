// Mesh colours: sample (i, j) of a triangle with n steps lies at barycentric b1 = i / n, b2 = j / n.
#include "board/sim/baked_tissue.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {
namespace {

std::uint8_t coded(float value) {
  return static_cast<std::uint8_t>(255 * std::sqrt(value) + 0.5F);
}

/// Row i holds steps - i + 1 samples.
std::size_t place(int steps, int i, int j) {
  return static_cast<std::size_t>(i * (steps + 1) - i * (i - 1) / 2 + j);
}

int steps_for(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& corners, float texel_mm) {
  const Eigen::Vector3f &a = mesh.vertices_mm[corners[0]], &b = mesh.vertices_mm[corners[1]],
                        &c = mesh.vertices_mm[corners[2]];
  const float longest_mm = std::max({(b - a).norm(), (c - a).norm(), (b - c).norm()});
  return std::clamp(static_cast<int>(std::ceil(longest_mm / texel_mm)), 1, 400);
}

}  // namespace

BakedTissue::BakedTissue(const TriangleMesh& mesh, const LivingTissue& tissue, float texel_mm)
    : mesh_(mesh), tissue_(tissue), samples_(mesh.triangles.size()) {
  for (const auto& corners : mesh.triangles)
    steps_.push_back(static_cast<std::uint16_t>(steps_for(mesh, corners, texel_mm)));
}

BakedTissue::~BakedTissue() {
  for (auto& samples : samples_) delete[] samples.load(std::memory_order_relaxed);
}

TissueSample BakedTissue::at(const RayHit& hit) const {
  const Sample* samples = samples_of(hit.triangle);
  const int steps = steps_[hit.triangle];
  const float u = std::clamp(hit.b1, 0.0F, 1.0F) * static_cast<float>(steps);
  const float v = std::clamp(hit.b2, 0.0F, 1.0F) * static_cast<float>(steps);
  const int i = std::min(static_cast<int>(u), steps - 1);
  const int j = std::min(static_cast<int>(v), steps - 1 - i);
  float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
  // The lower small triangle has its right angle at (i, j), the upper one, where there is one, at (i+1, j+1).
  const bool upper = fu + fv > 1 && i + j + 2 <= steps;
  const Sample& corner = samples[upper ? place(steps, i + 1, j + 1) : place(steps, i, j)];
  const Sample& along_u = samples[upper ? place(steps, i, j + 1) : place(steps, i + 1, j)];
  const Sample& along_v = samples[upper ? place(steps, i + 1, j) : place(steps, i, j + 1)];
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

const BakedTissue::Sample* BakedTissue::samples_of(std::uint32_t triangle) const {
  const Sample* there = samples_[triangle].load(std::memory_order_acquire);  // partner: the exchange below
  if (there != nullptr) return there;
  auto fresh = bake(triangle);
  // Partner: the load above. Whoever comes second throws the same samples away.
  if (samples_[triangle].compare_exchange_strong(there, fresh.get(), std::memory_order_acq_rel))
    return fresh.release();
  return there;
}

std::unique_ptr<BakedTissue::Sample[]> BakedTissue::bake(std::uint32_t triangle) const {
  const auto& corners = mesh_.triangles[triangle];
  const Eigen::Vector3f a = mesh_.vertices_mm[corners[0]];
  const Eigen::Vector3f ab = mesh_.vertices_mm[corners[1]] - a, ac = mesh_.vertices_mm[corners[2]] - a;
  const int steps = steps_[triangle];
  const float step = 1.0F / static_cast<float>(steps);
  auto samples = std::make_unique<Sample[]>(place(steps, steps, 0) + 1);
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps - i; ++j) {
      const TissueSample s =
          tissue_sample(a + static_cast<float>(i) * step * ab + static_cast<float>(j) * step * ac, tissue_);
      samples[place(steps, i, j)] = {coded(s.colour.x()), coded(s.colour.y()), coded(s.colour.z()),
                                     coded(s.gloss)};
    }
  return samples;
}

}  // namespace orcart
