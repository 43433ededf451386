// The depth picture of ScopeDepth made by the processor's vector units, as reciprocal depths.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "realtime/geometry/pose.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "render/atlas/scope_depth.hpp"
#include "render/atlas/software/texel_job.hpp"

namespace orcart {

class DepthRaster {
 public:
  /// The mesh must outlive it.
  DepthRaster(const TriangleMesh& mesh, const DepthPinhole& pinhole);

  /// Adds a part's triangles and occluders, both sides; the first part of a view clears. Any thread, one at a
  /// time; allocates nothing.
  void draw(const CutoutPatch& part, const Pose<C, M>& X_CM) noexcept;
  SeenDepths seen() const noexcept { return {per_mm_.data(), pinhole_.size_texels}; }

 private:
  const TriangleMesh* mesh_;
  DepthPinhole pinhole_;
  std::vector<float> per_mm_;  ///< size_texels squared, 1 / far_mm where nothing is seen
};

}  // namespace orcart
