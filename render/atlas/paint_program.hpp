// The paint shaders of the two modes: compiled for one scope, fed with one view at a time.
#pragma once

#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "render/atlas/paint_settings.hpp"
#include "render/atlas/scope_depth.hpp"
#include "render/atlas/surface_textures.hpp"
#include "render/gles/picture_texture.hpp"

namespace orcart {

/// What stays the same from view to view.
struct PaintConstants {
  TextureMode mode = TextureMode::perspective;
  int atlas_size_texels = 0;
  double texel_mm = 0.2;
  DepthPinhole pinhole;
};

/// What a view brings along.
struct PaintView {
  Pose<C, M> X_CM;
  PaperProjection paper;
  GLuint depth_texture = 0;
  GLuint mask_texture = 0;
  GLuint before_texture = 0;  ///< the records before this view
  std::uint32_t unit = 0;
  TurnedOptics optics;  ///< the scope's, at the turn of its light post
  ViewError error;
  float mean_light = 1;  ///< at which a brightness stays as it is
};

class PaintProgram {
 public:
  static Result<PaintProgram> create(const ScopeModel& scope, const PainterSettings& settings,
                                     const PaintConstants& constants);

  /// Makes the program current with all its textures and uniforms. Allocates nothing.
  void use(const PaintView& view, const SurfaceTextures& surface,
           const gles::PictureTexture& picture) const noexcept;

 private:
  PaintProgram() = default;
  void set_optics(const TurnedOptics& optics) const noexcept;
  void set_constants(const ScopeModel& scope, const PainterSettings& settings,
                     const PaintConstants& constants);

  gles::Program program_;
  GLint rotation_ = -1, translation_ = -1, tip_ = -1, view_ = -1, up_ = -1, side_ = -1, paper_size_ = -1,
        half_width_slope_ = -1, capture_ = -1, view_error_ = -1, light_ = -1, intrinsics_ = -1,
        coefficients_ = -1, distortion_centre_ = -1, circle_ = -1, notch_ = -1;
  Eigen::Vector2f fall_off_ = Eigen::Vector2f::Zero();  ///< reference mm, power of the vignetting's cosine
  gles::PictureTexture::Uniforms picture_{};
};

}  // namespace orcart
