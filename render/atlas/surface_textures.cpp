// Uploads the static textures of a surface; runs once.
#include "render/atlas/surface_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace orcart {
namespace {

constexpr int kRow = 2048;
constexpr float kNowhere_mm = 1e9F;  // beyond every far plane
constexpr std::uint32_t kNothing = 0x7FFFFFFF, kInside = 0x80000000;

int rows_for(std::size_t count) {
  return static_cast<int>((count + kRow - 1) / kRow);
}

gles::Texture owner_texture(const AtlasLayout& layout) {
  std::vector<std::uint32_t> words(layout.owners.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t triangle = layout.owners[i].triangle;
    words[i] = triangle == 0xFFFFFFFF ? kNothing : (triangle | (layout.inside[i] != 0 ? kInside : 0));
  }
  auto texture = gles::make_texture({GL_R32UI, layout.width_texels, layout.height_texels});
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, layout.width_texels, layout.height_texels, GL_RED_INTEGER,
                  GL_UNSIGNED_INT, words.data());
  return texture;
}

/// The point of a triangle nearest to one in its plane (Ericson 2005, section 5.1.5, by the edges alone).
Eigen::Vector3f nearest_on(const std::array<Eigen::Vector3f, 3>& corners, const Eigen::Vector3f& p) {
  Eigen::Vector3f nearest = corners[0];
  float least = INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f &a = corners[i], edge = corners[(i + 1) % 3] - a;
    const float along = std::clamp((p - a).dot(edge) / std::max(edge.squaredNorm(), 1e-20F), 0.0F, 1.0F);
    const Eigen::Vector3f on_edge = a + along * edge;
    if ((on_edge - p).squaredNorm() >= least) continue;
    least = (on_edge - p).squaredNorm();
    nearest = on_edge;
  }
  return nearest;
}

}  // namespace

float pack_normal(const Eigen::Vector3f& normal) {
  const float sum = normal.cwiseAbs().sum();
  if (!(sum > 0)) return 0;
  float u = normal.x() / sum, v = normal.y() / sum;
  if (normal.z() < 0) {
    const float folded_u = (1 - std::abs(v)) * (u < 0 ? -1.0f : 1.0f),
                folded_v = (1 - std::abs(u)) * (v < 0 ? -1.0f : 1.0f);
    u = folded_u;
    v = folded_v;
  }
  return std::round((u * 0.5f + 0.5f) * 2047) * 2048 + std::round((v * 0.5f + 0.5f) * 2047);
}

std::vector<float> texel_points(const TriangleMesh& mesh, const AtlasLayout& layout) {
  std::vector<float> points(layout.owners.size() * 4, kNowhere_mm);
  for (std::size_t i = 0; i < layout.owners.size(); ++i) {
    const TexelOwner& owner = layout.owners[i];
    if (owner.triangle == 0xFFFFFFFF) continue;
    const auto& corners = mesh.triangles[owner.triangle];
    const Eigen::Vector3f a = mesh.vertices_mm[corners[0]], ab = mesh.vertices_mm[corners[1]] - a,
                          ac = mesh.vertices_mm[corners[2]] - a;
    Eigen::Vector3f p = a + owner.b1 * ab + owner.b2 * ac;
    if (layout.inside[i] == 0) p = nearest_on({a, a + ab, a + ac}, p);
    std::copy_n(p.data(), 3, &points[4 * i]);
    points[4 * i + 3] = pack_normal(ab.cross(ac).normalized());
  }
  return points;
}

SurfaceTextures make_surface_textures(const TriangleMesh& mesh, const AtlasLayout& layout,
                                      const std::vector<float>& points) {
  SurfaceTextures textures{
      .owner = owner_texture(layout),
      .points = gles::make_texture({GL_RGBA32F, layout.width_texels, layout.height_texels})};
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, layout.width_texels, layout.height_texels, GL_RGBA, GL_FLOAT,
                  points.data());

  const int triangle_rows = rows_for(mesh.triangles.size());
  std::vector<std::uint32_t> corners(static_cast<std::size_t>(triangle_rows) * kRow * 4, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) corners[4 * t + c] = mesh.triangles[t][c];
  textures.triangles = gles::make_texture({GL_RGBA32UI, kRow, triangle_rows});
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kRow, triangle_rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                  corners.data());

  const int vertex_rows = rows_for(mesh.vertices_mm.size());
  std::vector<float> positions(static_cast<std::size_t>(vertex_rows) * kRow * 4, 0);
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      positions[4 * v + static_cast<std::size_t>(axis)] = mesh.vertices_mm[v][axis];
  textures.vertices = gles::make_texture({GL_RGBA32F, kRow, vertex_rows});
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kRow, vertex_rows, GL_RGBA, GL_FLOAT, positions.data());
  return textures;
}

}  // namespace orcart
