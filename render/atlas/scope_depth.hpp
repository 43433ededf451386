// What the scope sees first along each line of sight: a depth picture of the cutout from the camera's place.
#pragma once

#include <vector>

#include "realtime/geometry/pose.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "render/gles/objects.hpp"

namespace orcart {

/// The pinhole of the depth picture: a little wider than the viewing cone.
struct DepthPinhole {
  float tangent = 1;  ///< of the half angle
  float near_mm = 0.3f, far_mm = 80;
  int size_texels = 1024;
};

class ScopeDepth {
 public:
  static Result<ScopeDepth> create(const TriangleMesh& mesh, const DepthPinhole& pinhole);

  /// Adds a part's triangles and occluders; the first part of a view clears. Allocates nothing.
  void draw(const CutoutPatch& part, const Pose<C, M>& X_CM) noexcept;

  GLuint texture() const noexcept { return depth_.id(); }
  const DepthPinhole& pinhole() const noexcept { return pinhole_; }

 private:
  ScopeDepth() = default;
  void add(const std::vector<std::uint32_t>& triangles) noexcept;

  const TriangleMesh* mesh_ = nullptr;
  DepthPinhole pinhole_;
  gles::Texture depth_;
  gles::Framebuffer framebuffer_;
  gles::Program program_;
  gles::VertexArray vertex_array_;
  gles::Buffer positions_, indices_;
  std::vector<std::uint32_t> staged_;  ///< room for every triangle of the mesh
  GLint rotation_ = -1, translation_ = -1;
};

/// Column-major rotation and translation of a pose, as uniforms want them.
void set_pose_uniforms(GLint rotation, GLint translation, const Pose<C, M>& X_CM) noexcept;

}  // namespace orcart
