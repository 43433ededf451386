// The paint shaders of the two modes: compiled for one scope's choices, fed with one view at a time.
#pragma once

#include <vector>

#include "realtime/mapper/cutout_patch.hpp"
#include "render/atlas/paint_uniforms.hpp"
#include "render/atlas/surface_textures.hpp"
#include "render/gles/picture_texture.hpp"

namespace orcart {

/// What a view brings along.
struct PaintView {
  PaintUniforms uniforms;
  PaperProjection paper;
  GLuint depth_texture = 0;
  GLuint mask_texture = 0;
  GLuint before_texture = 0;  ///< the records before this view
};

class PaintProgram {
 public:
  static Result<PaintProgram> create(TextureMode mode, const PaintChoices& choices, int atlas_size_texels);

  /// Makes the program current with all its textures and uniforms. Allocates nothing.
  void use(const PaintView& view, const SurfaceTextures& surface,
           const gles::PictureTexture& picture) const noexcept;

 private:
  PaintProgram() = default;
  void set_numbers(const PaintUniforms& uniforms) const noexcept;

  gles::Program program_;
  std::vector<GLint> numbers_;  ///< in the order of PaintUniforms; -1 what this program does not use
  GLint tip_ = -1, view_ = -1, up_ = -1, side_ = -1, paper_size_ = -1, half_width_slope_ = -1;
  gles::PictureTexture::Uniforms picture_{};
};

}  // namespace orcart
