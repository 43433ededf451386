// The mesh is drawn when the eye moves; what it showed is shaded anew when the paint changes.
#include "render/views/surface_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <glm/gtc/type_ptr.hpp>

#include "render/shaders/shaders.hpp"

namespace orcart {
namespace {

constexpr std::array<float, 3> kGround{0.055f, 0.062f, 0.075f};

}  // namespace

Result<SurfaceView> SurfaceView::create(const Surface& surface, const AtlasLayout& layout,
                                        const SurfaceViewSettings& settings) {
  SurfaceView self;
  self.settings_ = settings;
  if (auto made = self.make_programs(); !made) return tl::unexpected(made.error());
  for (const auto& v : surface.mesh.vertices_mm) self.bounds_.extend(v);
  const ViewMesh fine = view_mesh(surface.mesh, layout);
  self.fine_ = load(fine);
  if (surface.mesh.triangles.size() > settings.most_triangles)
    self.coarse_ = load(coarser(fine, settings.most_triangles));
  if (auto made = self.make_targets(); !made) return tl::unexpected(made.error());
  return self;
}

Result<void> SurfaceView::make_programs() {
  const auto make = [](MeshProgram& to, const char* name, const char* fragment) -> Result<void> {
    auto program = gles::make_program(name, shaders::surface_vert, fragment);
    if (!program) return tl::unexpected(program.error());
    to.program = std::move(*program);
    to.view = gles::uniform(to.program, "u_view");
    to.projection = gles::uniform(to.program, "u_projection");
    return {};
  };
  if (auto made = make(look_, "surface", shaders::surface_frag); !made) return made;
  if (auto made = make(shell_, "shell", shaders::shell_frag); !made) return made;
  std::string shade = std::string("#define SHELL ") + (inside() ? "1\n" : "0\n") + "#define COLOUR_BY " +
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
  glUniform3fv(gles::uniform(shade_, "u_ground"), 1, kGround.data());
  no_attributes_ = gles::make_vertex_array();
  return {};
}

SurfaceView::Mesh SurfaceView::load(const ViewMesh& mesh) {
  Mesh loaded;
  loaded.index_count = static_cast<GLsizei>(mesh.indices.size());
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
  return loaded;
}

Result<void> SurfaceView::make_target(Target& to, GLenum format, GLuint depth) const {
  to.picture = gles::make_texture({format, settings_.width_px, settings_.height_px});
  auto framebuffer = gles::make_framebuffer(to.picture.id(), depth);
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  to.framebuffer = std::move(*framebuffer);
  return {};
}

Result<void> SurfaceView::make_targets() {
  depth_ = gles::make_depth_buffer(settings_.width_px, settings_.height_px);
  if (auto made = make_target(seen_, GL_RGBA16UI, depth_.id()); !made) return made;
  if (auto made = make_target(shelled_, GL_RGBA8, depth_.id()); !made) return made;
  if (coarse_.vertex_array) {
    finer_depth_ = gles::make_depth_buffer(settings_.width_px, settings_.height_px);
    if (auto made = make_target(finer_, GL_RGBA16UI, finer_depth_.id()); !made) return made;
  }
  return make_target(shown_, GL_RGBA8, 0);
}

void SurfaceView::draw(const Eye& eye, const PaintTextures& paint,
                       const Eigen::AlignedBox3f& changed) noexcept {
  if (looked_ && eye == eye_) {
    const bool was_settled = settled();
    if (!was_settled) refine();
    shade(paint, pixels_of(!was_settled && settled() ? bounds_ : changed));
    return;
  }
  look(eye);
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer.id());
  glClearColor(kGround[0], kGround[1], kGround[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  shade(paint, pixels_of(bounds_));
}

EyeMatrices SurfaceView::matrices() const noexcept {
  return matrices_of(eye_, static_cast<double>(settings_.width_px) / settings_.height_px);
}

/// The pixels on which a box may be seen: all of them where a corner is not before the eye.
SurfaceView::PixelBox SurfaceView::pixels_of(const Eigen::AlignedBox3f& box) const noexcept {
  constexpr float kMargin = 2;
  const Eigen::AlignedBox3f part = box.intersection(bounds_);
  if (part.isEmpty()) return {};
  const Eigen::Array2f size(static_cast<float>(settings_.width_px), static_cast<float>(settings_.height_px));
  const EyeMatrices from = matrices();
  Eigen::AlignedBox2f seen;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f p = part.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner));
    const glm::vec4 clip = from.projection * (from.view * glm::vec4(p.x(), p.y(), p.z(), 1));
    if (clip.w <= 0.01F) return {0, 0, settings_.width_px, settings_.height_px};
    seen.extend(Eigen::Vector2f(clip.x / clip.w * 0.5F + 0.5F, clip.y / clip.w * 0.5F + 0.5F));
  }
  const Eigen::Array2f low = (seen.min().array() * size - kMargin).max(0.0F).min(size);
  const Eigen::Array2f high = (seen.max().array() * size + kMargin).max(0.0F).min(size);
  const auto x = static_cast<int>(low.x()), y = static_cast<int>(low.y());
  return {x, y, static_cast<int>(std::ceil(high.x())) - x, static_cast<int>(std::ceil(high.y())) - y};
}

void SurfaceView::look(const Eye& eye) noexcept {
  looked_ = true;
  eye_ = eye;
  refined_ = 0;
  const Mesh& mesh = coarse_.vertex_array ? coarse_ : fine_;
  see(mesh, seen_, {0, mesh.index_count});
  if (inside()) draw_shell(mesh);
}

/// Adds the next part of the fine mesh to the picture that will take the coarse one's place.
void SurfaceView::refine() noexcept {
  const auto most = static_cast<GLsizei>(3 * settings_.most_triangles);
  const Range part{refined_, std::min(most, fine_.index_count - refined_)};
  see(fine_, finer_, part);
  refined_ += part.count;
}

/// Draws a range of a mesh into a picture of places, which the range that starts at 0 clears first.
void SurfaceView::see(const Mesh& mesh, const Target& target, const Range& range) noexcept {
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
  if (range.first == 0) {
    constexpr std::array<GLuint, 4> kNothing{};
    glClearBufferuiv(GL_COLOR, 0, kNothing.data());
    glClear(GL_DEPTH_BUFFER_BIT);
  }
  draw_mesh(look_, mesh, range, inside() ? GL_FRONT : GL_BACK);
  glDisable(GL_DEPTH_TEST);
}

void SurfaceView::draw_shell(const Mesh& mesh) noexcept {
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glBindFramebuffer(GL_FRAMEBUFFER, shelled_.framebuffer.id());
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  draw_mesh(shell_, mesh, {0, mesh.index_count}, GL_BACK);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
}

void SurfaceView::draw_mesh(const MeshProgram& with, const Mesh& mesh, const Range& range,
                            GLenum culled) noexcept {
  const EyeMatrices from = matrices();
  glUseProgram(with.program.id());
  glUniformMatrix4fv(with.view, 1, GL_FALSE, glm::value_ptr(from.view));
  glUniformMatrix4fv(with.projection, 1, GL_FALSE, glm::value_ptr(from.projection));
  glBindVertexArray(mesh.vertex_array.id());
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // the projection turns the picture over
  glCullFace(culled);
  const std::uintptr_t offset_bytes = static_cast<std::uintptr_t>(range.first) * sizeof(std::uint32_t);
  glDrawElements(GL_TRIANGLES, range.count, GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset_bytes));
  glDisable(GL_CULL_FACE);
  glBindVertexArray(0);
}

void SurfaceView::shade(const PaintTextures& paint, const PixelBox& part) noexcept {
  if (part.width <= 0 || part.height <= 0) return;
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, part.y, part.width, part.height);
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer.id());
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glDisable(GL_BLEND);
  glUseProgram(shade_.id());
  const Target& seen = coarse_.vertex_array && settled() ? finer_ : seen_;
  const std::array<GLuint, 4> textures{seen.picture.id(), paint.atlas, shelled_.picture.id(), paint.records};
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

void SurfaceView::copy_to(GLuint framebuffer, int x_px, int y_px) const noexcept {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, shown_.framebuffer.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, settings_.width_px, settings_.height_px, x_px, y_px, x_px + settings_.width_px,
                    y_px + settings_.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace orcart
