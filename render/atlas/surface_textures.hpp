// The surface and its atlas layout as textures, so that the paint shader finds the point behind every texel.
#pragma once

#include <vector>

#include "realtime/geometry/triangle_mesh.hpp"
#include "render/atlas/atlas_layout.hpp"
#include "render/gles/objects.hpp"

namespace orcart {

struct SurfaceTextures {
  gles::Texture
      owner;  ///< R32UI, atlas size: triangle, bit 31 where the centre lies inside it; 0x7FFFFFFF nothing
  gles::Texture points;  ///< RGBA32F, atlas size: the point behind the texel, M, mm, 1e9 where there is none;
                         ///< in a gutter the nearest of its triangle, which is seen or hidden as that is, so
                         ///< that no seam stays bare; the normal in w, see pack_normal
  gles::Texture triangles;  ///< RGBA32UI, row-wrapped: the three vertices
  gles::Texture vertices;   ///< RGBA32F, row-wrapped: positions in M, mm
};

/// A unit vector as one float: octahedral coordinates (Meyer et al. 2010), 11 bits each, error below 0.06
/// degrees.
float pack_normal(const Eigen::Vector3f& normal);

/// Of every texel, what SurfaceTextures::points holds.
std::vector<float> texel_points(const TriangleMesh& mesh, const AtlasLayout& layout);

SurfaceTextures make_surface_textures(const TriangleMesh& mesh, const AtlasLayout& layout,
                                      const std::vector<float>& points);

}  // namespace orcart
