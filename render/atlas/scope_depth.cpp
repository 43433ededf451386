// Draws the cutout's triangles, both sides, into a depth texture.
#include "render/atlas/scope_depth.hpp"

#include "render/shaders/shaders.hpp"

namespace orcart {

void set_pose_uniforms(GLint rotation, GLint translation, const Pose<C, M>& X_CM) noexcept {
  const Eigen::Matrix3f r = X_CM.rotation.cast<float>();
  const Eigen::Vector3f t = X_CM.translation_mm.cast<float>();
  glUniformMatrix3fv(rotation, 1, GL_FALSE, r.data());
  glUniform3fv(translation, 1, t.data());
}

Result<ScopeDepth> ScopeDepth::create(const TriangleMesh& mesh, const DepthPinhole& pinhole) {
  ScopeDepth self;
  self.mesh_ = &mesh;
  self.pinhole_ = pinhole;
  self.depth_ = gles::make_texture({GL_DEPTH_COMPONENT32F, pinhole.size_texels, pinhole.size_texels});
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  self.framebuffer_ = gles::Framebuffer(id);
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, self.depth_.id(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return fail("the driver cannot draw into a depth texture of 32 bits");
  }
  auto program = gles::make_program("depth", shaders::depth_vert, shaders::depth_frag);
  if (!program) return tl::unexpected(program.error());
  self.program_ = std::move(*program);
  self.rotation_ = gles::uniform(self.program_, "u_rotation_CM");
  self.translation_ = gles::uniform(self.program_, "u_translation_CM");
  glUseProgram(self.program_.id());
  glUniform1f(gles::uniform(self.program_, "u_depth_tangent"), pinhole.tangent);
  glUniform1f(gles::uniform(self.program_, "u_depth_near"), pinhole.near_mm);
  glUniform1f(gles::uniform(self.program_, "u_depth_far"), pinhole.far_mm);

  self.vertex_array_ = gles::make_vertex_array();
  glBindVertexArray(self.vertex_array_.id());
  self.positions_ = gles::make_buffer(GL_ARRAY_BUFFER, mesh.vertices_mm.size() * sizeof(Eigen::Vector3f),
                                      mesh.vertices_mm.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Eigen::Vector3f), nullptr);
  self.staged_.reserve(mesh.triangles.size() * 3);
  self.indices_ = gles::make_buffer(
      GL_ELEMENT_ARRAY_BUFFER, mesh.triangles.size() * 3 * sizeof(std::uint32_t), nullptr, GL_STREAM_DRAW);
  glBindVertexArray(0);
  return self;
}

void ScopeDepth::add(const std::vector<std::uint32_t>& triangles) noexcept {
  for (const std::uint32_t t : triangles) {
    const auto& corners = mesh_->triangles[t];
    staged_.insert(staged_.end(), corners.begin(), corners.end());
  }
}

void ScopeDepth::draw(const CutoutPatch& part, const Pose<C, M>& X_CM) noexcept {
  staged_.clear();
  add(part.triangles);
  add(part.occluders);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, pinhole_.size_texels, pinhole_.size_texels);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  if (part.first_part) glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(program_.id());
  set_pose_uniforms(rotation_, translation_, X_CM);
  glBindVertexArray(vertex_array_.id());
  glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(staged_.size() * sizeof(std::uint32_t)),
                  staged_.data());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(staged_.size()), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace orcart
