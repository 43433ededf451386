// The newest camera picture on the GPU, as raw planes in several finenesses; shaders convert it where they
// look (shaders/picture.glsl).
#pragma once

#include "realtime/base/image.hpp"
#include "render/gles/dma_buf_framebuffers.hpp"
#include "render/gles/objects.hpp"
#include "render/gles/picture_copy.hpp"
#include "render/gles/picture_pyramid.hpp"

namespace orcart::gles {

/// Fixed size; the format may change from picture to picture. Upload allocates nothing of our own.
class PictureTexture {
 public:
  PictureTexture(int width_px, int height_px, PictureCopy copy = PictureCopy::cpu,
                 PicturePyramid::Keeps keeps = PicturePyramid::Keeps::coarser_levels);

  /// Pictures of another size or an unknown format are refused (false), and the last one stays. The picture's
  /// memory is done with on return: the GPU's own copy is waited for.
  bool upload(const ImageDescriptor& image) noexcept;
  /// cpu from the first picture on that the GPU could not read.
  PictureCopy copy() const noexcept { return copy_; }
  bool empty() const noexcept { return format_ < 0; }
  /// The picture in memory: where all levels are kept, and the GPU does not copy for itself.
  PicturePlanes in_memory() const noexcept;

  /// Binds to texture units `unit` and `unit + 1` and sets the uniforms of shaders/picture.glsl. A picture
  /// that was kept in memory goes up to the GPU only here.
  struct Uniforms {
    GLint format, luma, chroma, size;
  };
  static Uniforms uniforms_of(const Program& program);
  void bind(const Uniforms& uniforms, int unit) const noexcept;

 private:
  /// A texture of one plane, all its levels.
  struct Plane {
    Plane(GLenum internal_format, GLenum upload_format, PicturePyramid levels);
    void upload(const ImagePlane& from) noexcept;
    void send(int level, const std::uint8_t* pixels) const noexcept;
    void send_kept() const noexcept;  ///< if they have not been

    PicturePyramid pyramid;
    int width, height, channels;
    GLenum format;
    Texture texture;
    mutable bool unsent = false;  ///< newer in memory
  };

  /// Those that hold the picture.
  const Plane& luma() const noexcept;
  const Plane& chroma() const noexcept;
  void upload(Plane& plane, const ImagePlane& from, std::uint64_t modifier) noexcept;
  /// False where the GPU cannot read there; looked at when a buffer is first seen.
  bool copy_on_gpu(const Plane& plane, const ImagePlane& from, std::uint64_t modifier) noexcept;
  bool holds(const Plane& plane, const ImagePlane& picture) noexcept;

  int width_px_, height_px_;
  PictureCopy copy_;
  std::vector<std::uint8_t> row_;  ///< read back
  DmaBufFramebuffers buffers_;
  int format_ = -1;  ///< as u_picture_format; -1 before the first upload
  Plane rgba_, y_, y_with_chroma_, cbcr_, packed_;
};

}  // namespace orcart::gles
