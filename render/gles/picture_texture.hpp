// The newest camera picture on the GPU, as raw planes in several finenesses; shaders convert it where they
// look (shaders/picture.glsl).
#pragma once

#include "realtime/base/image.hpp"
#include "render/gles/objects.hpp"
#include "render/gles/picture_pyramid.hpp"

namespace orcart::gles {

/// Fixed size; the format may change from picture to picture. Upload allocates nothing of our own.
class PictureTexture {
 public:
  PictureTexture(int width_px, int height_px);

  /// Pictures of another size or an unknown format are refused (false), and the last one stays.
  bool upload(const ImageDescriptor& image) noexcept;
  bool empty() const noexcept { return format_ < 0; }

  /// Binds to texture units `unit` and `unit + 1` and sets the uniforms of shaders/picture.glsl.
  struct Uniforms {
    GLint format, luma, chroma, size;
  };
  static Uniforms uniforms_of(const Program& program);
  void bind(const Uniforms& uniforms, int unit) const noexcept;

 private:
  /// A texture of one plane, all its levels.
  struct Plane {
    Plane(GLenum internal_format, GLenum upload_format, int width, int height, int channels);
    void upload(const ImagePlane& from) noexcept;

    int width, height, channels;
    GLenum format;
    PicturePyramid pyramid;
    Texture texture;
  };

  int width_px_, height_px_;
  int format_ = -1;  ///< as u_picture_format; -1 before the first upload
  Plane rgba_, y_, y_with_chroma_, cbcr_, packed_;
};

}  // namespace orcart::gles
