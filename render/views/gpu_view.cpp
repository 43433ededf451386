// Meshes into pictures of places, and those into colours, by shaders.
#include "render/views/gpu_view.hpp"

#include <string>

#include <glm/gtc/type_ptr.hpp>

#include "render/shaders/shaders.hpp"

namespace orcart {

Result<GpuView> GpuView::create(const ViewMeshes& meshes, const SurfaceViewSettings& settings) {
  GpuView self;
  self.settings_ = settings;
  if (auto made = self.make_programs(); !made) return tl::unexpected(made.error());
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].indices.empty() && i > 0) continue;
    Mesh& mesh = self.meshes_[i];
    load(meshes[i], mesh);
    mesh.depth = gles::make_depth_buffer(settings.width_px, settings.height_px);
    if (auto made = self.make_target(mesh.seen, GL_RGBA16UI, mesh.depth.id()); !made)
      return tl::unexpected(made.error());
  }
  const Mesh& looked_through = self.meshes_[meshes[1].indices.empty() ? 0 : 1];
  if (auto made = self.make_target(self.shelled_, GL_RGBA8, looked_through.depth.id()); !made)
    return tl::unexpected(made.error());
  if (auto made = self.make_target(self.shown_, GL_RGBA8, 0); !made) return tl::unexpected(made.error());
  return self;
}

Result<void> GpuView::make_programs() {
  const auto make = [](MeshProgram& to, const char* name, const char* fragment) -> Result<void> {
    const std::string rules = std::string(shaders::dialect_glsl) + shaders::view_glsl;
    auto program = gles::make_program(name, rules + shaders::surface_vert, rules + fragment);
    if (!program) return tl::unexpected(program.error());
    to.program = std::move(*program);
    to.view = gles::uniform(to.program, "u_view");
    to.projection = gles::uniform(to.program, "u_projection");
    return {};
  };
  if (auto made = make(look_, "surface", shaders::surface_frag); !made) return made;
  if (auto made = make(shell_, "shell", shaders::shell_frag); !made) return made;
  std::string shade = std::string(shaders::dialect_glsl) + shaders::view_glsl + "#define SHELL " +
                      (inside() ? "1\n" : "0\n") + "#define COLOUR_BY " +
                      std::to_string(static_cast<int>(settings_.colour_by)) + "\n";
  if (settings_.colour_by != ColourBy::picture) shade += shaders::colouring_glsl;
  shade += shaders::shade_frag;
  auto program = gles::make_program("shade", shaders::shade_vert, shade);
  if (!program) return tl::unexpected(program.error());
  shade_ = std::move(*program);
  glUseProgram(shade_.id());
  glUniform1i(gles::uniform(shade_, "u_seen"), 0);
  glUniform1i(gles::uniform(shade_, "u_atlas"), 1);
  glUniform1i(gles::uniform(shade_, "u_shell"), 2);
  glUniform1i(gles::uniform(shade_, "u_records"), 3);
  glUniform1f(gles::uniform(shade_, "u_end_of_ramp"), static_cast<float>(end_of_ramp(settings_.colour_by)));
  glUniform3fv(gles::uniform(shade_, "u_ground"), 1, kViewGround.data());
  no_attributes_ = gles::make_vertex_array();
  return {};
}

void GpuView::load(const ViewMesh& mesh, Mesh& loaded) {
  loaded.index_count = mesh.indices.size();
  loaded.vertex_array = gles::make_vertex_array();
  glBindVertexArray(loaded.vertex_array.id());
  loaded.vertices = gles::make_buffer(GL_ARRAY_BUFFER, mesh.vertices.size() * sizeof(ViewVertex),
                                      mesh.vertices.data(), GL_STATIC_DRAW);
  const std::array<std::pair<GLint, std::size_t>, 3> fields{{{3, offsetof(ViewVertex, position)},
                                                             {3, offsetof(ViewVertex, normal)},
                                                             {2, offsetof(ViewVertex, texel)}}};
  glBindVertexBuffer(0, loaded.vertices.id(), 0, sizeof(ViewVertex));
  for (GLuint i = 0; i < fields.size(); ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribFormat(i, fields[i].first, GL_FLOAT, GL_FALSE, static_cast<GLuint>(fields[i].second));
    glVertexAttribBinding(i, 0);
  }
  loaded.indices = gles::make_buffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.size() * sizeof(std::uint32_t),
                                     mesh.indices.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
}

Result<void> GpuView::make_target(Target& to, GLenum format, GLuint depth) const {
  to.picture = gles::make_texture({format, settings_.width_px, settings_.height_px});
  auto framebuffer = gles::make_framebuffer(to.picture.id(), depth);
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  to.framebuffer = std::move(*framebuffer);
  return {};
}

void GpuView::see(Fineness which, const IndexRange& indices, const EyeMatrices& from) noexcept {
  const Mesh& seen = mesh(which);
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glBindFramebuffer(GL_FRAMEBUFFER, seen.seen.framebuffer.id());
  if (indices.first == 0) {
    constexpr std::array<GLuint, 4> kNothing{};
    glClearBufferuiv(GL_COLOR, 0, kNothing.data());
    glClear(GL_DEPTH_BUFFER_BIT);
  }
  draw_mesh(look_, seen, indices, from, inside() ? GL_FRONT : GL_BACK);
  glDisable(GL_DEPTH_TEST);
}

void GpuView::draw_shell(Fineness which, const EyeMatrices& from) noexcept {
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glBindFramebuffer(GL_FRAMEBUFFER, shelled_.framebuffer.id());
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  draw_mesh(shell_, mesh(which), {0, mesh(which).index_count}, from, GL_BACK);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
}

void GpuView::draw_mesh(const MeshProgram& with, const Mesh& mesh, const IndexRange& indices,
                        const EyeMatrices& from, GLenum culled) noexcept {
  glUseProgram(with.program.id());
  glUniformMatrix4fv(with.view, 1, GL_FALSE, glm::value_ptr(from.view));
  glUniformMatrix4fv(with.projection, 1, GL_FALSE, glm::value_ptr(from.projection));
  glBindVertexArray(mesh.vertex_array.id());
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // the projection turns the picture over
  glCullFace(culled);
  const std::uintptr_t offset_bytes = indices.first * sizeof(std::uint32_t);  // GL takes it as a pointer
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(offset_bytes));  // NOLINT(performance-no-int-to-ptr)
  glDisable(GL_CULL_FACE);
  glBindVertexArray(0);
}

void GpuView::shade(Fineness which, const PaintedAtlas& paint, const PixelBox& part) noexcept {
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, part.y, part.width, part.height);
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer.id());
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glDisable(GL_BLEND);
  glUseProgram(shade_.id());
  const std::array<GLuint, 4> textures{mesh(which).seen.picture.id(), paint.colour_texture,
                                       shelled_.picture.id(), paint.record_texture};
  for (GLenum i = 0; i < textures.size(); ++i) {
    glActiveTexture(GL_TEXTURE0 + i);
    glBindTexture(GL_TEXTURE_2D, textures[i]);
  }
  glActiveTexture(GL_TEXTURE0);
  glBindVertexArray(no_attributes_.id());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glBindVertexArray(0);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace orcart
