// Raw planes into textures; a packed 4:2:2 picture goes up twice, once seen as luma pairs and once as chroma
// pairs.
#include "render/gles/picture_texture.hpp"

#include <algorithm>

namespace orcart::gles {
namespace {
constexpr int kMostLevels = 4;  // below the picture itself
}  // namespace

PictureTexture::Plane::Plane(GLenum internal_format, GLenum upload_format, int plane_width, int plane_height,
                             int channel_count)
    : width(plane_width),
      height(plane_height),
      channels(channel_count),
      format(upload_format),
      pyramid(width, height, channels, exact_halvings(width, height, kMostLevels)),
      texture(make_texture({internal_format, width, height, GL_LINEAR, 1 + pyramid.levels()})) {}

void PictureTexture::Plane::upload(const ImagePlane& from) noexcept {
  const auto* pixels = reinterpret_cast<const std::uint8_t*>(from.data + from.offset_bytes);
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(from.stride_bytes) / channels);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, format, GL_UNSIGNED_BYTE, pixels);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  pyramid.build({pixels, from.stride_bytes, width, height});
  for (int level = 1; level <= pyramid.levels(); ++level)
    glTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, width >> level, height >> level, format, GL_UNSIGNED_BYTE,
                    pyramid.level(level));
}

PictureTexture::PictureTexture(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      rgba_(GL_RGBA8, GL_RGBA, width_px, height_px, 4),
      y_(GL_R8, GL_RED, width_px, height_px, 1),
      y_with_chroma_(GL_RG8, GL_RG, width_px, height_px, 2),
      cbcr_(GL_RG8, GL_RG, std::max(width_px / 2, 1), std::max(height_px / 2, 1), 2),
      packed_(GL_RGBA8, GL_RGBA, std::max(width_px / 2, 1), height_px, 4) {}

bool PictureTexture::upload(const ImageDescriptor& image) noexcept {
  if (image.width_px != width_px_ || image.height_px != height_px_ || image.planes[0].data == nullptr)
    return false;
  switch (image.format) {
    case PixelFormat::rgba8888:
      rgba_.upload(image.planes[0]);
      format_ = 0;
      return true;
    case PixelFormat::nv12:
      y_.upload(image.planes[0]);
      cbcr_.upload(image.planes[1]);
      format_ = 1;
      return true;
    case PixelFormat::yuyv:
    case PixelFormat::uyvy:
      y_with_chroma_.upload(image.planes[0]);
      packed_.upload(image.planes[0]);
      format_ = image.format == PixelFormat::yuyv ? 2 : 3;
      return true;
    case PixelFormat::gray8:
      y_.upload(image.planes[0]);
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
  const Plane* luma = &rgba_;
  const Plane* chroma = &cbcr_;
  if (format_ == 1 || format_ == 4) luma = &y_;
  if (format_ == 2 || format_ == 3) {
    luma = &y_with_chroma_;
    chroma = &packed_;
  }
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, luma->texture.id());
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit) + 1);
  glBindTexture(GL_TEXTURE_2D, chroma->texture.id());
  glUniform1i(uniforms.format, format_);
  glUniform1i(uniforms.luma, unit);
  glUniform1i(uniforms.chroma, unit + 1);
  glUniform2f(uniforms.size, static_cast<float>(width_px_), static_cast<float>(height_px_));
}

}  // namespace orcart::gles
