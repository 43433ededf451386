// One draw of the mesh, twice where the near wall is a shell, with several samples a pixel.
#include "render/views/surface_view.hpp"

#include <array>
#include <map>
#include <vector>

#include <Eigen/Geometry>
#include <glm/gtc/type_ptr.hpp>

#include "render/shaders/shaders.hpp"

namespace orcart {
namespace {

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
  auto program = gles::make_program("surface", shaders::surface_vert, shaders::surface_frag);
  if (!program) return tl::unexpected(program.error());
  self.program_ = std::move(*program);
  glUseProgram(self.program_.id());
  glUniform1f(gles::uniform(self.program_, "u_atlas_size"), static_cast<float>(layout.width_texels));
  glUniform1i(gles::uniform(self.program_, "u_atlas"), 0);
  self.view_ = gles::uniform(self.program_, "u_view");
  self.projection_ = gles::uniform(self.program_, "u_projection");
  self.shell_ = gles::uniform(self.program_, "u_shell");
  self.load(surface, layout);
  if (auto made = self.make_targets(); !made) return tl::unexpected(made.error());
  return self;
}

// A vertex is split where its charts meet, because there it has several places in the atlas.
void SurfaceView::load(const Surface& surface, const AtlasLayout& layout) {
  const TriangleMesh& mesh = surface.mesh;
  const auto normals = vertex_normals(mesh);
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
  for (GLuint i = 0; i < fields.size(); ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, fields[i].first, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(fields[i].second));
  }
  indices_ = gles::make_buffer(GL_ELEMENT_ARRAY_BUFFER, indices.size() * sizeof(std::uint32_t),
                               indices.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
}

Result<void> SurfaceView::make_targets() {
  const int width = settings_.width_px, height = settings_.height_px;
  picture_ = gles::make_texture({GL_RGBA8, width, height});
  auto resolved = gles::make_framebuffer(picture_.id());
  if (!resolved) return tl::unexpected(resolved.error());
  resolved_ = std::move(*resolved);
  if (settings_.samples <= 1) {
    depth_ = gles::make_depth_buffer(width, height);
    auto drawn = gles::make_framebuffer(picture_.id(), depth_.id());
    if (!drawn) return tl::unexpected(drawn.error());
    drawn_ = std::move(*drawn);
    return {};
  }
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  many_colours_ = gles::Renderbuffer(id);
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, settings_.samples, GL_RGBA8, width, height);
  glGenRenderbuffers(1, &id);
  depth_ = gles::Renderbuffer(id);
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, settings_.samples, GL_DEPTH_COMPONENT24, width, height);
  glGenFramebuffers(1, &id);
  drawn_ = gles::Framebuffer(id);
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, many_colours_.id());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.id());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return fail("the driver cannot draw with " + std::to_string(settings_.samples) + " samples a pixel");
  }
  return {};
}

void SurfaceView::draw_faces(GLenum culled) noexcept {
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // the projection turns the picture over
  glCullFace(culled);
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_CULL_FACE);
}

void SurfaceView::draw(const Eye& eye, GLuint atlas_texture) noexcept {
  glBindFramebuffer(GL_FRAMEBUFFER, drawn_.id());
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glClearColor(0.055f, 0.062f, 0.075f, 1);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glUseProgram(program_.id());
  const EyeMatrices matrices =
      matrices_of(eye, static_cast<double>(settings_.width_px) / settings_.height_px);
  glUniformMatrix4fv(view_, 1, GL_FALSE, glm::value_ptr(matrices.view));
  glUniformMatrix4fv(projection_, 1, GL_FALSE, glm::value_ptr(matrices.projection));
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, atlas_texture);
  glBindVertexArray(vertex_array_.id());
  glUniform1i(shell_, 0);
  draw_faces(settings_.seen_from == SeenFrom::inside ? GL_FRONT : GL_BACK);
  if (settings_.seen_from == SeenFrom::inside) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glUniform1i(shell_, 1);
    draw_faces(GL_BACK);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }
  glBindVertexArray(0);
  glDisable(GL_DEPTH_TEST);
  if (settings_.samples <= 1) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.id());
  glBlitFramebuffer(0, 0, settings_.width_px, settings_.height_px, 0, 0, settings_.width_px,
                    settings_.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void SurfaceView::copy_to(GLuint framebuffer, int x_px, int y_px) const noexcept {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, settings_.width_px, settings_.height_px, x_px, y_px, x_px + settings_.width_px,
                    y_px + settings_.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace orcart
