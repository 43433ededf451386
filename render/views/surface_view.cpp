// The mesh is drawn when the eye moves; what it showed is shaded anew when the paint changes.
#include "render/views/surface_view.hpp"

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <glm/gtc/type_ptr.hpp>

#include "render/shaders/shaders.hpp"

namespace orcart {
namespace {

constexpr std::array<float, 3> kGround{0.055f, 0.062f, 0.075f};

struct Vertex {
  std::array<float, 3> position, normal;
  std::array<float, 2> texel;
};

/// Area-weighted normals of the vertices.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices_mm.size(), Eigen::Vector3f::Zero());
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices_mm[t[0]], &b = mesh.vertices_mm[t[1]], &c = mesh.vertices_mm[t[2]];
    const Eigen::Vector3f doubled_area = (b - a).cross(c - a);
    for (const std::uint32_t corner : t) normals[corner] += doubled_area;
  }
  for (auto& n : normals) n.normalize();
  return normals;
}

}  // namespace

Result<SurfaceView> SurfaceView::create(const Surface& surface, const AtlasLayout& layout,
                                        const SurfaceViewSettings& settings) {
  SurfaceView self;
  self.settings_ = settings;
  if (auto made = self.make_programs(); !made) return tl::unexpected(made.error());
  self.load(surface, layout);
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
  const std::string shade = std::string("#define SHELL ") + (inside() ? "1\n" : "0\n") + shaders::shade_frag;
  auto program = gles::make_program("shade", shaders::shade_vert, shade);
  if (!program) return tl::unexpected(program.error());
  shade_ = std::move(*program);
  glUseProgram(shade_.id());
  glUniform1i(gles::uniform(shade_, "u_seen"), 0);
  glUniform1i(gles::uniform(shade_, "u_atlas"), 1);
  glUniform1i(gles::uniform(shade_, "u_shell"), 2);
  glUniform3fv(gles::uniform(shade_, "u_ground"), 1, kGround.data());
  no_attributes_ = gles::make_vertex_array();
  return {};
}

// A vertex is split where its charts meet, because there it has several places in the atlas.
void SurfaceView::load(const Surface& surface, const AtlasLayout& layout) {
  const TriangleMesh& mesh = surface.mesh;
  const auto normals = vertex_normals(mesh);
  for (const auto& v : mesh.vertices_mm) bounds_.extend(v);
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  indices.reserve(mesh.triangles.size() * 3);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;  // (chart, vertex)
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangles[t][c];
      const auto [at, is_new] =
          numbers.try_emplace({layout.chart_of_triangle[t], v}, static_cast<std::uint32_t>(vertices.size()));
      if (is_new) {
        const auto &p = mesh.vertices_mm[v], &n = normals[v];
        const auto& uv = layout.corners_texels[t][c];
        vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {uv.x(), uv.y()}});
      }
      indices.push_back(at->second);
    }
  }
  index_count_ = static_cast<GLsizei>(indices.size());
  vertex_array_ = gles::make_vertex_array();
  glBindVertexArray(vertex_array_.id());
  vertices_ =
      gles::make_buffer(GL_ARRAY_BUFFER, vertices.size() * sizeof(Vertex), vertices.data(), GL_STATIC_DRAW);
  const std::array<std::pair<GLint, std::size_t>, 3> fields{
      {{3, offsetof(Vertex, position)}, {3, offsetof(Vertex, normal)}, {2, offsetof(Vertex, texel)}}};
  glBindVertexBuffer(0, vertices_.id(), 0, sizeof(Vertex));
  for (GLuint i = 0; i < fields.size(); ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribFormat(i, fields[i].first, GL_FLOAT, GL_FALSE, static_cast<GLuint>(fields[i].second));
    glVertexAttribBinding(i, 0);
  }
  indices_ = gles::make_buffer(GL_ELEMENT_ARRAY_BUFFER, indices.size() * sizeof(std::uint32_t),
                               indices.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
}

Result<void> SurfaceView::make_targets() {
  const int width = settings_.width_px, height = settings_.height_px;
  depth_ = gles::make_depth_buffer(width, height);
  const auto make = [&](Target& to, GLenum format, GLuint depth) -> Result<void> {
    to.picture = gles::make_texture({format, width, height});
    auto framebuffer = gles::make_framebuffer(to.picture.id(), depth);
    if (!framebuffer) return tl::unexpected(framebuffer.error());
    to.framebuffer = std::move(*framebuffer);
    return {};
  };
  if (auto made = make(seen_, GL_RGBA16UI, depth_.id()); !made) return made;
  if (auto made = make(shelled_, GL_RGBA8, depth_.id()); !made) return made;
  return make(shown_, GL_RGBA8, 0);
}

void SurfaceView::draw(const Eye& eye, GLuint atlas_texture, const Eigen::AlignedBox3f& changed) noexcept {
  if (looked_ && eye == eye_) {
    shade(atlas_texture, pixels_of(changed));
    return;
  }
  look(eye);
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer.id());
  glClearColor(kGround[0], kGround[1], kGround[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  shade(atlas_texture, pixels_of(bounds_));
}

/// The pixels on which a box may be seen: all of them where a corner is not before the eye.
SurfaceView::PixelBox SurfaceView::pixels_of(const Eigen::AlignedBox3f& box) const noexcept {
  constexpr float kMargin = 2;
  const Eigen::AlignedBox3f part = box.intersection(bounds_);
  if (part.isEmpty()) return {};
  const Eigen::Array2f size(static_cast<float>(settings_.width_px), static_cast<float>(settings_.height_px));
  const EyeMatrices matrices =
      matrices_of(eye_, static_cast<double>(settings_.width_px) / settings_.height_px);
  Eigen::AlignedBox2f seen;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f p = part.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner));
    const glm::vec4 clip = matrices.projection * (matrices.view * glm::vec4(p.x(), p.y(), p.z(), 1));
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
  const EyeMatrices matrices =
      matrices_of(eye, static_cast<double>(settings_.width_px) / settings_.height_px);
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glBindFramebuffer(GL_FRAMEBUFFER, seen_.framebuffer.id());
  constexpr std::array<GLuint, 4> kNothing{};
  glClearBufferuiv(GL_COLOR, 0, kNothing.data());
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_mesh(look_, matrices, inside() ? GL_FRONT : GL_BACK);
  if (inside()) {
    glBindFramebuffer(GL_FRAMEBUFFER, shelled_.framebuffer.id());
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    draw_mesh(shell_, matrices, GL_BACK);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }
  glDisable(GL_DEPTH_TEST);
}

void SurfaceView::draw_mesh(const MeshProgram& with, const EyeMatrices& matrices, GLenum culled) noexcept {
  glUseProgram(with.program.id());
  glUniformMatrix4fv(with.view, 1, GL_FALSE, glm::value_ptr(matrices.view));
  glUniformMatrix4fv(with.projection, 1, GL_FALSE, glm::value_ptr(matrices.projection));
  glBindVertexArray(vertex_array_.id());
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // the projection turns the picture over
  glCullFace(culled);
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(0);
}

void SurfaceView::shade(GLuint atlas_texture, const PixelBox& part) noexcept {
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, part.y, part.width, part.height);
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer.id());
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glDisable(GL_BLEND);
  glUseProgram(shade_.id());
  const std::array<GLuint, 3> textures{seen_.picture.id(), atlas_texture, shelled_.picture.id()};
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
