// Raw planes into textures; a packed 4:2:2 picture goes up twice, once seen as luma pairs and once as chroma
// pairs.
#include "render/gles/picture_texture.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace orcart::gles {
namespace {
constexpr int kMostLevels = 4;             // below the picture itself
constexpr std::size_t kMostImported = 64;  // V4L2 gives 32 buffers at most, of which two planes are read

/// The DRM format in which bytes are channels, in order.
constexpr std::uint32_t drm_format_of(int channels) {
  if (channels == 1) return fourcc('R', '8', ' ', ' ');
  return channels == 2 ? fourcc('G', 'R', '8', '8') : fourcc('A', 'B', '2', '4');
}

PicturePyramid pyramid_of(int width, int height, int channels, PicturePyramid::Keeps keeps) {
  return {width, height, channels, exact_halvings(width, height, kMostLevels), keeps};
}
}  // namespace

PictureTexture::Plane::Plane(GLenum internal_format, GLenum upload_format, PicturePyramid levels)
    : pyramid(std::move(levels)),
      width(pyramid.in_memory().width),
      height(pyramid.in_memory().height),
      channels(pyramid.in_memory().channels),
      format(upload_format),
      texture(make_texture({internal_format, width, height, GL_LINEAR, 1 + pyramid.levels()})) {}

void PictureTexture::Plane::upload(const ImagePlane& from) noexcept {
  const auto* pixels = reinterpret_cast<const std::uint8_t*>(from.data + from.offset_bytes);
  pyramid.build({pixels, from.stride_bytes, width, height});
  unsent = pyramid.keeps_all();
  if (unsent) return;
  glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(from.stride_bytes) / channels);
  send(0, pixels);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  for (int level = 1; level <= pyramid.levels(); ++level) send(level, pyramid.level(level));
}

void PictureTexture::Plane::send(int level, const std::uint8_t* pixels) const noexcept {
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, width >> level, height >> level, format, GL_UNSIGNED_BYTE,
                  pixels);
}

void PictureTexture::Plane::send_kept() const noexcept {
  for (int level = 0; unsent && level <= pyramid.levels(); ++level) send(level, pyramid.level(level));
  unsent = false;
}

// There are drivers (kms_swrast for one) that import a foreign buffer and then read nothing there.
bool PictureTexture::holds(const Plane& plane, const ImagePlane& picture) noexcept {
  constexpr int kRows = 8;
  const auto copied = make_framebuffer(plane.texture.id());
  if (!copied) return false;
  for (int i = 0; i < kRows; ++i) {
    const int y = (2 * i + 1) * plane.height / (2 * kRows);
    glReadPixels(0, y, plane.width, 1, GL_RGBA, GL_UNSIGNED_BYTE, row_.data());
    const std::byte* expected =
        picture.data + picture.offset_bytes + static_cast<std::size_t>(y) * picture.stride_bytes;
    for (int x = 0; x < plane.width; ++x)
      if (std::memcmp(&row_[static_cast<std::size_t>(4 * x)], expected + x * plane.channels,
                      static_cast<std::size_t>(plane.channels)) != 0)
        return false;
  }
  return true;
}

// The coarser levels are means of 2 x 2 there too, give or take a driver's rounding.
bool PictureTexture::copy_on_gpu(const Plane& plane, const ImagePlane& from,
                                 std::uint64_t modifier) noexcept {
  const std::size_t known = buffers_.imported();
  const GLuint framebuffer = buffers_.over(from, {.drm_format = drm_format_of(plane.channels),
                                                  .width_px = plane.width,
                                                  .height_px = plane.height,
                                                  .modifier = modifier});
  if (framebuffer == 0) return false;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glBindTexture(GL_TEXTURE_2D, plane.texture.id());
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, plane.width, plane.height);
  if (plane.pyramid.levels() > 0) glGenerateMipmap(GL_TEXTURE_2D);
  return buffers_.imported() == known || holds(plane, from);
}

void PictureTexture::upload(Plane& plane, const ImagePlane& from, std::uint64_t modifier) noexcept {
  if (copy_ == PictureCopy::gpu && from.dma_buf_fd >= 0) {
    if (copy_on_gpu(plane, from, modifier)) return;
    copy_ = PictureCopy::cpu;
  }
  plane.upload(from);
}

PictureTexture::PictureTexture(int width_px, int height_px, PictureCopy copy, PicturePyramid::Keeps keeps)
    : width_px_(width_px),
      height_px_(height_px),
      copy_(copy),
      row_(copy == PictureCopy::gpu ? 4 * static_cast<std::size_t>(width_px) : 0),
      buffers_(kMostImported),
      rgba_(GL_RGBA8, GL_RGBA, pyramid_of(width_px, height_px, 4, keeps)),
      y_(GL_R8, GL_RED, pyramid_of(width_px, height_px, 1, keeps)),
      y_with_chroma_(GL_RG8, GL_RG, pyramid_of(width_px, height_px, 2, keeps)),
      cbcr_(GL_RG8, GL_RG, pyramid_of(std::max(width_px / 2, 1), std::max(height_px / 2, 1), 2, keeps)),
      packed_(GL_RGBA8, GL_RGBA, pyramid_of(std::max(width_px / 2, 1), height_px, 4, keeps)) {}

bool PictureTexture::upload(const ImageDescriptor& image) noexcept {
  if (image.width_px != width_px_ || image.height_px != height_px_ || image.planes[0].data == nullptr)
    return false;
  switch (image.format) {
    case PixelFormat::rgba8888:
      upload(rgba_, image.planes[0], image.modifier);
      format_ = 0;
      break;
    case PixelFormat::nv12:
      upload(y_, image.planes[0], image.modifier);
      upload(cbcr_, image.planes[1], image.modifier);
      format_ = 1;
      break;
    case PixelFormat::yuyv:
    case PixelFormat::uyvy:
      upload(y_with_chroma_, image.planes[0], image.modifier);
      upload(packed_, image.planes[0], image.modifier);
      format_ = image.format == PixelFormat::yuyv ? 2 : 3;
      break;
    case PixelFormat::gray8:
      upload(y_, image.planes[0], image.modifier);
      format_ = 4;
      break;
    case PixelFormat::xrgb8888:
    case PixelFormat::none:
      return false;
  }
  if (copy_ == PictureCopy::gpu && image.planes[0].dma_buf_fd >= 0) glFinish();
  return true;
}

PictureTexture::Uniforms PictureTexture::uniforms_of(const Program& program) {
  return {uniform(program, "u_picture_format"), uniform(program, "u_luma"), uniform(program, "u_chroma"),
          uniform(program, "u_picture_size")};
}

const PictureTexture::Plane& PictureTexture::luma() const noexcept {
  if (format_ == 1 || format_ == 4) return y_;
  return format_ == 2 || format_ == 3 ? y_with_chroma_ : rgba_;
}

const PictureTexture::Plane& PictureTexture::chroma() const noexcept {
  return format_ == 2 || format_ == 3 ? packed_ : cbcr_;
}

PicturePlanes PictureTexture::in_memory() const noexcept {
  return {.format = format_, .luma = luma().pyramid.in_memory(), .chroma = chroma().pyramid.in_memory()};
}

void PictureTexture::bind(const Uniforms& uniforms, int unit) const noexcept {
  luma().send_kept();
  chroma().send_kept();
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, luma().texture.id());
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit) + 1);
  glBindTexture(GL_TEXTURE_2D, chroma().texture.id());
  glUniform1i(uniforms.format, format_);
  glUniform1i(uniforms.luma, unit);
  glUniform1i(uniforms.chroma, unit + 1);
  glUniform2f(uniforms.size, static_cast<float>(width_px_), static_cast<float>(height_px_));
}

}  // namespace orcart::gles
