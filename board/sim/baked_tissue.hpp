// Tissue sampled on the surface once, so that drawing a picture only looks it up: a grid of samples in each
// triangle.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "board/sim/tissue.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// Samples every texel_mm or finer inside a triangle ("mesh colours", Yuksel 2010), taken when it is first
/// seen. The result does not depend on which thread comes first. Any number of threads may ask; the mesh is
/// borrowed.
class BakedTissue {
 public:
  BakedTissue(const TriangleMesh& mesh, const LivingTissue& tissue, float texel_mm);
  ~BakedTissue();
  BakedTissue(const BakedTissue&) = delete;
  BakedTissue& operator=(const BakedTissue&) = delete;

  /// Interpolated linearly between the three samples about the hit.
  TissueSample at(const RayHit& hit) const;

 private:
  using Sample = std::array<std::uint8_t, 4>;  ///< square roots of red, green, blue, gloss; 255 is 1
  const Sample* samples_of(std::uint32_t triangle) const;
  std::unique_ptr<Sample[]> bake(std::uint32_t triangle) const;

  const TriangleMesh& mesh_;
  LivingTissue tissue_;
  std::vector<std::uint16_t> steps_;  ///< per triangle: samples along an edge, less one
  mutable std::vector<std::atomic<const Sample*>> samples_;  ///< per triangle, null until first seen
};

}  // namespace orcart
