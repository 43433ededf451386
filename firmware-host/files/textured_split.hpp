// A painted surface for programs that know one place in the picture per vertex: vertices repeated along the
// seams.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "firmware-host/files/textured_file.hpp"

namespace orcart {

/// The surface's own vertices come first, in their order; then each again for every further place it has.
struct SplitSurface {
  std::vector<std::uint32_t> vertex_of;  ///< the surface's vertex behind each
  std::vector<Eigen::Vector2f> places;   ///< 0..1, origin bottom left
  std::vector<std::uint32_t> indices;    ///< three a triangle
};
SplitSurface split_along_seams(const TexturedSurface& textured);

}  // namespace orcart
