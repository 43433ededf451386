// The paint shaders of the two modes: compiled for one scope, fed with one view at a time.
#pragma once

#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/scope_depth.hpp"
#include "render/atlas/surface_textures.hpp"
#include "render/gles/picture_texture.hpp"

namespace orcart {

/// What stays the same from view to view.
struct PaintConstants {
  TextureMode mode = TextureMode::perspective;
  int atlas_size_texels = 0;
  float facing = 1;  ///< +1 seen from outside, -1 from inside
  double max_obliquity_rad = 1.3963;
  bool even_out_light = false;
  DepthPinhole pinhole;
};

/// What a view brings along.
struct PaintView {
  Pose<C, M> X_CM;
  PaperProjection paper;
  GLuint depth_texture = 0;
  GLuint mask_texture = 0;
};

class PaintProgram {
 public:
  static Result<PaintProgram> create(const ScopeModel& scope, const PaintConstants& constants);

  /// Makes the program current with all its textures and uniforms. Allocates nothing.
  void use(const PaintView& view, const SurfaceTextures& surface,
           const gles::PictureTexture& picture) const noexcept;

 private:
  PaintProgram() = default;
  void set_constants(const ScopeModel& scope, const PaintConstants& constants);

  gles::Program program_;
  GLint rotation_ = -1, translation_ = -1, tip_ = -1, view_ = -1, up_ = -1, side_ = -1, paper_size_ = -1,
        half_width_slope_ = -1;
  gles::PictureTexture::Uniforms picture_{};
};

}  // namespace orcart
