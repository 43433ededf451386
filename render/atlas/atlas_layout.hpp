// Where every triangle has its place in the one picture that the paint is kept in. Built once per surface, on
// the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

struct AtlasSettings {
  double texel_mm = 0.2;  ///< wished for; made coarser, and said so, where the surface would not fit
  int max_size_texels = 4096;
  int gutter_texels = 2;
};

/// A rectangle of the atlas that belongs to one chart, gutter included.
struct ChartRect {
  std::uint16_t x = 0, y = 0, width = 0, height = 0;
};

/// What a texel shows: a triangle and barycentric coordinates on it; in the gutter they lie outside the
/// triangle.
struct TexelOwner {
  std::uint32_t triangle = 0xFFFFFFFF;  ///< 0xFFFFFFFF: nothing
  float b1 = 0, b2 = 0;                 ///< weights of corners 1 and 2; corner 0 has 1 - b1 - b2
};

/// Deterministic: the same mesh and settings give the same layout, bit for bit.
struct AtlasLayout {
  int width_texels = 0, height_texels = 0;
  double texel_mm = 0;  ///< what was reached
  std::vector<ChartRect> charts;
  std::vector<std::uint32_t> chart_of_triangle;
  std::vector<std::array<Eigen::Vector2f, 3>>
      corners_texels;                ///< per triangle corner; (0,0) is the corner of texel 0
  std::vector<TexelOwner> owners;    ///< width * height, row by row
  std::vector<std::uint8_t> inside;  ///< 1 where the texel's centre lies in its triangle (no gutter)
};

Result<AtlasLayout> build_atlas(const TriangleMesh& mesh, const AtlasSettings& settings);

/// Each triangle's corners in the picture as other programs say it: 0..1, origin bottom left.
std::vector<std::array<Eigen::Vector2f, 3>> picture_places(const AtlasLayout& layout);

}  // namespace orcart
