// The painted surface from any eye, kept as a picture until the paint or the eye changes.
#pragma once

#include "render/atlas/atlas_layout.hpp"
#include "render/gles/objects.hpp"
#include "render/views/eye.hpp"

namespace orcart {

struct SurfaceViewSettings {
  int width_px = 1280, height_px = 800;
  SeenFrom seen_from = SeenFrom::outside;  ///< inside: the near wall is a glass shell, so that one looks in
  int samples = 1;                         ///< of each pixel, against jagged edges; 1: none
};

class SurfaceView {
 public:
  static Result<SurfaceView> create(const Surface& surface, const AtlasLayout& layout,
                                    const SurfaceViewSettings& settings);

  /// Draws into the kept picture. Allocates nothing of our own.
  void draw(const Eye& eye, GLuint atlas_texture) noexcept;
  /// Copies the kept picture to the bound draw framebuffer at a place given in pixels from its row 0.
  void copy_to(GLuint framebuffer, int x_px, int y_px) const noexcept;
  GLuint framebuffer() const noexcept { return resolved_.id(); }
  const SurfaceViewSettings& settings() const noexcept { return settings_; }

 private:
  SurfaceView() = default;
  Result<void> make_targets();
  void load(const Surface& surface, const AtlasLayout& layout);
  void draw_faces(GLenum culled) noexcept;

  SurfaceViewSettings settings_;
  gles::Program program_;
  gles::VertexArray vertex_array_;
  gles::Buffer vertices_, indices_;
  GLsizei index_count_ = 0;
  gles::Texture picture_;
  gles::Renderbuffer many_colours_, depth_;
  gles::Framebuffer resolved_, drawn_;
  GLint view_ = -1, projection_ = -1, shell_ = -1;
};

}  // namespace orcart
