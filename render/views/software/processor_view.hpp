// The surface for an eye, drawn and coloured by the processor's vector units; what changed goes up to a
// texture that the panel's picture is put together from.
#pragma once

#include <array>
#include <vector>

#include "render/gles/objects.hpp"
#include "render/views/software/view_job.hpp"

namespace orcart {

class ProcessorView final : public ViewDrawing {
 public:
  static Result<ProcessorView> create(const ViewMeshes& meshes, const SurfaceViewSettings& settings);

  void see(Fineness mesh, const IndexRange& indices, const EyeMatrices& from) noexcept override;
  void draw_shell(Fineness mesh, const EyeMatrices& from) noexcept override;
  void shade(Fineness mesh, const PaintedAtlas& paint, const PixelBox& part) noexcept override;
  std::uint32_t framebuffer() const noexcept override { return framebuffer_.id(); }

 private:
  struct Mesh {
    std::array<std::vector<float>, 8> numbers;  ///< as VertexNumbers
    std::vector<std::uint32_t> indices;
    std::vector<SeenVertex> seen;
    std::vector<float> nearness;
    std::vector<std::uint32_t> place, light;
  };
  ProcessorView() = default;
  void load(const ViewMesh& mesh, Mesh& to) const;
  std::size_t pixels() const noexcept;
  PlacePicture places_of(Mesh& mesh) const noexcept;
  ViewJob job_of(Mesh& mesh, const EyeMatrices& from) const noexcept;
  Mesh& mesh(Fineness which) noexcept { return meshes_[static_cast<std::size_t>(which)]; }

  SurfaceViewSettings settings_;
  int stride_ = 0;  ///< pixels from row to row
  std::array<Mesh, 2> meshes_;
  std::vector<std::uint32_t> shell_, shown_;
  gles::Texture picture_;
  gles::Framebuffer framebuffer_;
};

}  // namespace orcart
