// What DepthRaster hands to its vector code: plain memory.
#pragma once

#include <array>
#include <cstdint>

namespace orcart {

struct DepthJob {
  std::array<float, 9> R_CM{};  ///< column by column
  std::array<float, 3> t_CM{};  ///< mm
  float tangent = 1, near_mm = 0.3F;
  int size_texels = 0;
  const float* vertices_mm = nullptr;       ///< x y z, M
  const std::int32_t* triangles = nullptr;  ///< three vertex numbers each
  float* per_mm = nullptr;  ///< size_texels squared, a vector's length readable and writable beyond
};

}  // namespace orcart
