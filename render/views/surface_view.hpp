// The painted surface from any eye, kept as a picture until the paint or the eye changes; coarser while the
// eye moves.
#pragma once

#include <Eigen/Geometry>

#include "render/atlas/colouring.hpp"
#include "render/gles/objects.hpp"
#include "render/views/eye.hpp"
#include "render/views/view_mesh.hpp"

namespace orcart {

struct SurfaceViewSettings {
  int width_px = 1280, height_px = 800;
  SeenFrom seen_from = SeenFrom::outside;  ///< inside: the near wall is a glass shell, so that one looks in
  ColourBy colour_by = ColourBy::picture;
  /// Of one draw(): a surface with more is drawn coarser for a new eye, and then finer, part by part.
  std::size_t most_triangles = 50'000;
};

/// What is on the surface, as GL names.
struct PaintTextures {
  GLuint atlas = 0, records = 0;
};

class SurfaceView {
 public:
  static Result<SurfaceView> create(const Surface& surface, const AtlasLayout& layout,
                                    const SurfaceViewSettings& settings);

  /// Draws into the kept picture. For a new eye the mesh; for the same eye only the paint, and only where the
  /// box `changed` of M (mm) is seen, and of a coarse view the next part of the fine one. Allocates nothing
  /// of our own.
  void draw(const Eye& eye, const PaintTextures& paint, const Eigen::AlignedBox3f& changed) noexcept;
  /// False while draw() would make the same eye's picture finer.
  bool settled() const noexcept { return refined_ == fine_.index_count || !coarse_.vertex_array; }
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
  struct Mesh {
    gles::VertexArray vertex_array;
    gles::Buffer vertices, indices;
    GLsizei index_count = 0;
  };
  struct Range {
    GLsizei first = 0, count = 0;  ///< indices
  };
  SurfaceView() = default;
  Result<void> make_programs();
  Result<void> make_targets();
  Result<void> make_target(Target& to, GLenum format, GLuint depth) const;
  static Mesh load(const ViewMesh& mesh);
  bool inside() const noexcept { return settings_.seen_from == SeenFrom::inside; }
  struct PixelBox {
    int x = 0, y = 0, width = 0, height = 0;
  };
  PixelBox pixels_of(const Eigen::AlignedBox3f& box) const noexcept;
  EyeMatrices matrices() const noexcept;
  void look(const Eye& eye) noexcept;
  void refine() noexcept;
  void see(const Mesh& mesh, const Target& target, const Range& range) noexcept;
  void draw_mesh(const MeshProgram& with, const Mesh& mesh, const Range& range, GLenum culled) noexcept;
  void draw_shell(const Mesh& mesh) noexcept;
  void shade(const PaintTextures& paint, const PixelBox& part) noexcept;

  SurfaceViewSettings settings_;
  MeshProgram look_, shell_;
  gles::Program shade_;
  gles::VertexArray no_attributes_;
  Mesh fine_, coarse_;  ///< coarse: none where the fine one is small enough
  gles::Renderbuffer depth_, finer_depth_;
  Target seen_;          ///< RGBA16UI: place in the atlas and light, per pixel
  Target finer_;         ///< what is seen once the fine mesh is in it
  GLsizei refined_ = 0;  ///< indices of the fine mesh that are in `finer_`
  Target shelled_;       ///< inside: the near wall's rim
  Target shown_;         ///< the picture
  bool looked_ = false;
  Eye eye_;
  Eigen::AlignedBox3f bounds_;  ///< of the surface
};

}  // namespace orcart
