// Raw planes into textures; a packed 4:2:2 picture goes up twice, once seen as luma pairs and once as chroma
// pairs.
#include "render/gles/picture_texture.hpp"

namespace orcart::gles {
namespace {

struct Upload {
  const Texture& texture;
  int width, height;
  GLenum format;
  int bytes_per_texel;
};

void upload_plane(const ImagePlane& plane, const Upload& to) noexcept {
  glBindTexture(GL_TEXTURE_2D, to.texture.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(plane.stride_bytes) / to.bytes_per_texel);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, to.width, to.height, to.format, GL_UNSIGNED_BYTE,
                  plane.data + plane.offset_bytes);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

}  // namespace

PictureTexture::PictureTexture(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      rgba_(make_texture({GL_RGBA8, width_px, height_px, GL_LINEAR})),
      y_(make_texture({GL_R8, width_px, height_px, GL_LINEAR})),
      y_with_chroma_(make_texture({GL_RG8, width_px, height_px, GL_LINEAR})),
      cbcr_(make_texture({GL_RG8, (width_px + 1) / 2, (height_px + 1) / 2, GL_LINEAR})),
      packed_(make_texture({GL_RGBA8, (width_px + 1) / 2, height_px, GL_LINEAR})) {}

bool PictureTexture::upload(const ImageDescriptor& image) noexcept {
  if (image.width_px != width_px_ || image.height_px != height_px_ || image.planes[0].data == nullptr)
    return false;
  switch (image.format) {
    case PixelFormat::rgba8888:
      upload_plane(image.planes[0], {rgba_, width_px_, height_px_, GL_RGBA, 4});
      format_ = 0;
      return true;
    case PixelFormat::nv12:
      upload_plane(image.planes[0], {y_, width_px_, height_px_, GL_RED, 1});
      upload_plane(image.planes[1], {cbcr_, width_px_ / 2, height_px_ / 2, GL_RG, 2});
      format_ = 1;
      return true;
    case PixelFormat::yuyv:
    case PixelFormat::uyvy:
      upload_plane(image.planes[0], {y_with_chroma_, width_px_, height_px_, GL_RG, 2});
      upload_plane(image.planes[0], {packed_, width_px_ / 2, height_px_, GL_RGBA, 4});
      format_ = image.format == PixelFormat::yuyv ? 2 : 3;
      return true;
    case PixelFormat::gray8:
      upload_plane(image.planes[0], {y_, width_px_, height_px_, GL_RED, 1});
      format_ = 4;
      return true;
    case PixelFormat::xrgb8888:
    case PixelFormat::none:
      break;
  }
  return false;
}

PictureTexture::Uniforms PictureTexture::uniforms_of(const Program& program) {
  return {uniform(program, "u_picture_format"), uniform(program, "u_luma"), uniform(program, "u_chroma"),
          uniform(program, "u_picture_size")};
}

void PictureTexture::bind(const Uniforms& uniforms, int unit) const noexcept {
  const Texture* luma = &rgba_;
  const Texture* chroma = &cbcr_;
  if (format_ == 1 || format_ == 4) luma = &y_;
  if (format_ == 2 || format_ == 3) {
    luma = &y_with_chroma_;
    chroma = &packed_;
  }
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, luma->id());
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit) + 1);
  glBindTexture(GL_TEXTURE_2D, chroma->id());
  glUniform1i(uniforms.format, format_);
  glUniform1i(uniforms.luma, unit);
  glUniform1i(uniforms.chroma, unit + 1);
  glUniform2f(uniforms.size, static_cast<float>(width_px_), static_cast<float>(height_px_));
}

}  // namespace orcart::gles
