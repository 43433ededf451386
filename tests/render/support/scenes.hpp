// Small surfaces, scopes and pictures that the drawing tests share.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "realtime/base/image.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/atlas_layout.hpp"
#include "render/atlas/paint_settings.hpp"

namespace orcart::scenes {

/// A square of `cells` x `cells` cells in z = depth_mm, centred on the z axis, its normal towards -z.
inline Surface plane(double depth_mm, double side_mm, std::uint32_t cells) {
  Surface surface;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i)
      surface.mesh.vertices_mm.emplace_back(static_cast<float>((i / double(cells) - 0.5) * side_mm),
                                            static_cast<float>((j / double(cells) - 0.5) * side_mm),
                                            static_cast<float>(depth_mm));
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      surface.mesh.triangles.push_back({a, c, b});
      surface.mesh.triangles.push_back({b, c, d});
    }
  return surface;
}

/// Adds the triangles of `more` to `surface`.
inline void append(Surface& surface, const Surface& more) {
  const auto first = static_cast<std::uint32_t>(surface.mesh.vertices_mm.size());
  surface.mesh.vertices_mm.insert(surface.mesh.vertices_mm.end(), more.mesh.vertices_mm.begin(),
                                  more.mesh.vertices_mm.end());
  for (auto t : more.mesh.triangles)
    surface.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// A sphere by latitude and longitude, outward normals.
inline Surface sphere(const Eigen::Vector3f& centre_mm, float radius_mm, std::uint32_t steps) {
  Surface surface;
  const auto point = [&](std::uint32_t i, std::uint32_t j) {
    const double theta = std::numbers::pi * i / steps, phi = 2 * std::numbers::pi * j / (2 * steps);
    return Eigen::Vector3f(centre_mm +
                           radius_mm * Eigen::Vector3f(static_cast<float>(std::sin(theta) * std::cos(phi)),
                                                       static_cast<float>(std::sin(theta) * std::sin(phi)),
                                                       static_cast<float>(std::cos(theta))));
  };
  surface.mesh.vertices_mm.push_back(point(0, 0));
  for (std::uint32_t i = 1; i < steps; ++i)
    for (std::uint32_t j = 0; j < 2 * steps; ++j) surface.mesh.vertices_mm.push_back(point(i, j));
  surface.mesh.vertices_mm.push_back(point(steps, 0));
  const auto last = static_cast<std::uint32_t>(surface.mesh.vertices_mm.size() - 1);
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * 2 * steps + j % (2 * steps); };
  for (std::uint32_t j = 0; j < 2 * steps; ++j) {
    surface.mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (std::uint32_t i = 1; i + 1 < steps; ++i) {
      surface.mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    surface.mesh.triangles.push_back({at(steps - 1, j), last, at(steps - 1, j + 1)});
  }
  surface.closed = true;
  return surface;
}

/// 640x480, barrel distortion like a neuro-endoscope's, circle of 222 px.
inline ScopeModel scope(LensModel model = LensModel::brown) {
  ScopeModel scope;
  scope.name = "test scope";
  scope.width_px = 640;
  scope.height_px = 480;
  scope.lens = {.model = model, .fx_px = 340, .fy_px = 338, .cx_px = 322.5, .cy_px = 238.25};
  if (model == LensModel::brown) scope.lens.coefficients = {-0.26, 0.07, 0.0008, -0.0005, 0};
  if (model == LensModel::fisheye) scope.lens.coefficients = {0.02, -0.03, 0.004, 0, 0};
  if (model == LensModel::poly4) {
    scope.lens.coefficients = {1e-4, 1.2e-6, 2e-9, 0, 0};
    scope.lens.distortion_centre_px = {320, 240};
  }
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.2);
  scope.mask = {.cx_px = 321, .cy_px = 239, .radius_px = 222, .soft_edge_px = 6};
  scope.cone_half_angle_rad = 0.68;
  return scope;
}

/// A patch that offers every triangle of a surface to the painter.
inline CutoutPatch whole(const Surface& surface, const Pose<M, C>& X_MC,
                         TextureMode mode = TextureMode::perspective) {
  CutoutPatch patch(surface.mesh.triangles.size());
  patch.X_MC = X_MC;
  patch.mode = mode;
  for (std::uint32_t t = 0; t < surface.mesh.triangles.size(); ++t) patch.triangles.push_back(t);
  return patch;
}

/// With whom the program of tests was built for.
#ifdef ORCART_PAINT_BY_PROCESSOR
inline constexpr PaintBy kPaintBy = PaintBy::processor;
#else
inline constexpr PaintBy kPaintBy = PaintBy::gpu;
#endif
inline PainterSettings painted_by(PainterSettings settings) {
  settings.paint_by = kPaintBy;
  return settings;
}

/// The point on the surface behind texel i.
inline Eigen::Vector3d point_of(const Surface& surface, const AtlasLayout& layout, std::size_t i) {
  const TexelOwner& owner = layout.owners[i];
  const auto& corners = surface.mesh.triangles[owner.triangle];
  const Eigen::Vector3d a = surface.mesh.vertices_mm[corners[0]].cast<double>(),
                        b = surface.mesh.vertices_mm[corners[1]].cast<double>(),
                        c = surface.mesh.vertices_mm[corners[2]].cast<double>();
  return a + double(owner.b1) * (b - a) + double(owner.b2) * (c - a);
}

/// A tight RGBA picture that owns its pixels.
struct Rgba {
  int width_px, height_px;
  std::vector<std::uint8_t> bytes;
  ImageDescriptor descriptor() {
    return packed_image(reinterpret_cast<std::byte*>(bytes.data()), PixelFormat::rgba8888, width_px,
                        height_px);
  }
};

/// Red rises with x, green with y: a pixel can be read off a colour.
inline Rgba ramp(const ScopeModel& scope) {
  Rgba picture{scope.width_px, scope.height_px, {}};
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x)
      picture.bytes.insert(
          picture.bytes.end(),
          {static_cast<std::uint8_t>(std::lround(255.0 * x / (scope.width_px - 1))),
           static_cast<std::uint8_t>(std::lround(255.0 * y / (scope.height_px - 1))), 60, 255});
  return picture;
}

/// One colour all over.
inline Rgba flat(const ScopeModel& scope, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Rgba picture{scope.width_px, scope.height_px, {}};
  for (int i = 0; i < scope.width_px * scope.height_px; ++i)
    picture.bytes.insert(picture.bytes.end(), {r, g, b, 255});
  return picture;
}

}  // namespace orcart::scenes
