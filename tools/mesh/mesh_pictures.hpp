// Pictures of a surface for a report, drawn with rays: shaded, coloured or not, from a chosen side.
#pragma once

#include <array>
#include <functional>

#include "firmware-host/files/picture_file.hpp"
#include "realtime/geometry/ray_scene.hpp"

namespace orcart {

struct MeshView {
  int width_px = 480, height_px = 480;
  Eigen::Vector3f from = Eigen::Vector3f::UnitX();  ///< from the surface's centre to the eye, LPS
  Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  SeenFrom seen_from = SeenFrom::outside;  ///< inside: the wall that is nearer is left out
};

/// Red, green, blue, 0..1, for a point of the surface.
using MeshColour = std::function<Eigen::Vector3f(const RayHit& hit, const Eigen::Vector3f& place_mm)>;

/// Parallel projection, light from the eye, white where there is nothing. `colour` empty: bone.
Picture draw_mesh(const TriangleMesh& mesh, const RayScene& rays, const MeshView& view,
                  const MeshColour& colour = {});

}  // namespace orcart
