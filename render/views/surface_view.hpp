// The painted surface from any eye, kept as a picture until the paint or the eye changes.
#pragma once

#include <Eigen/Geometry>

#include "render/atlas/atlas_layout.hpp"
#include "render/gles/objects.hpp"
#include "render/views/eye.hpp"

namespace orcart {

struct SurfaceViewSettings {
  int width_px = 1280, height_px = 800;
  SeenFrom seen_from = SeenFrom::outside;  ///< inside: the near wall is a glass shell, so that one looks in
};

class SurfaceView {
 public:
  static Result<SurfaceView> create(const Surface& surface, const AtlasLayout& layout,
                                    const SurfaceViewSettings& settings);

  /// Draws into the kept picture. For a new eye the mesh; for the same eye only the paint, and only where the
  /// box `changed` of M (mm) is seen. Allocates nothing of our own.
  void draw(const Eye& eye, GLuint atlas_texture, const Eigen::AlignedBox3f& changed) noexcept;
  /// Copies the kept picture to the bound draw framebuffer at a place given in pixels from its row 0.
  void copy_to(GLuint framebuffer, int x_px, int y_px) const noexcept;
  GLuint framebuffer() const noexcept { return shown_.framebuffer.id(); }
  const SurfaceViewSettings& settings() const noexcept { return settings_; }

 private:
  /// A program that draws the mesh.
  struct MeshProgram {
    gles::Program program;
    GLint view = -1, projection = -1;
  };
  struct Target {
    gles::Texture picture;
    gles::Framebuffer framebuffer;
  };
  SurfaceView() = default;
  Result<void> make_programs();
  Result<void> make_targets();
  void load(const Surface& surface, const AtlasLayout& layout);
  bool inside() const noexcept { return settings_.seen_from == SeenFrom::inside; }
  struct PixelBox {
    int x = 0, y = 0, width = 0, height = 0;
  };
  PixelBox pixels_of(const Eigen::AlignedBox3f& box) const noexcept;
  void look(const Eye& eye) noexcept;
  void draw_mesh(const MeshProgram& with, const EyeMatrices& matrices, GLenum culled) noexcept;
  void shade(GLuint atlas_texture, const PixelBox& part) noexcept;

  SurfaceViewSettings settings_;
  MeshProgram look_, shell_;
  gles::Program shade_;
  gles::VertexArray vertex_array_, no_attributes_;
  gles::Buffer vertices_, indices_;
  GLsizei index_count_ = 0;
  gles::Renderbuffer depth_;
  Target seen_;     ///< RGBA16UI: place in the atlas and light, per pixel
  Target shelled_;  ///< inside: the near wall's rim
  Target shown_;    ///< the picture
  bool looked_ = false;
  Eye eye_;
  Eigen::AlignedBox3f bounds_;  ///< of the surface
};

}  // namespace orcart
