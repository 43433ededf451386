// The surface for an eye as the driver draws it.
#pragma once

#include "render/gles/objects.hpp"
#include "render/views/view_drawing.hpp"

namespace orcart {

class GpuView final : public ViewDrawing {
 public:
  static Result<GpuView> create(const ViewMeshes& meshes, const SurfaceViewSettings& settings);

  void see(Fineness mesh, const IndexRange& indices, const EyeMatrices& from) noexcept override;
  void draw_shell(Fineness mesh, const EyeMatrices& from) noexcept override;
  void shade(Fineness mesh, const PaintedAtlas& paint, const PixelBox& part) noexcept override;
  std::uint32_t framebuffer() const noexcept override { return shown_.framebuffer.id(); }

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
    std::size_t index_count = 0;
    gles::Renderbuffer depth;
    Target seen;  ///< RGBA16UI: place in the atlas and light, per pixel
  };
  GpuView() = default;
  Result<void> make_programs();
  Result<void> make_target(Target& to, GLenum format, GLuint depth) const;
  static void load(const ViewMesh& mesh, Mesh& to);
  bool inside() const noexcept { return settings_.seen_from == SeenFrom::inside; }
  Mesh& mesh(Fineness which) noexcept { return meshes_[static_cast<std::size_t>(which)]; }
  void draw_mesh(const MeshProgram& with, const Mesh& mesh, const IndexRange& indices,
                 const EyeMatrices& from, GLenum culled) noexcept;

  SurfaceViewSettings settings_;
  MeshProgram look_, shell_;
  gles::Program shade_;
  gles::VertexArray no_attributes_;
  std::array<Mesh, 2> meshes_;
  Target shelled_;  ///< inside: the near wall's rim
  Target shown_;    ///< the picture
};

}  // namespace orcart
