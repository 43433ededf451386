// A small picture of its own, copied into the panel's.
#include "render/views/software/processor_inset.hpp"

#include <cmath>

namespace orcart {

Result<ProcessorInset> ProcessorInset::create(float centre_x, float centre_y, float radius_px, float aspect) {
  constexpr int kVector = 16;  // the longest, in pixels
  ProcessorInset self;
  self.x_ = static_cast<int>(std::floor(centre_x - radius_px));
  self.y_ = static_cast<int>(std::floor(centre_y - radius_px));
  InsetJob& job = self.job_;
  job.centre_x = centre_x - static_cast<float>(self.x_);
  job.centre_y = centre_y - static_cast<float>(self.y_);
  job.radius_px = radius_px;
  job.width = static_cast<int>(std::ceil(job.centre_x + radius_px));
  job.height = static_cast<int>(std::ceil(job.centre_y + radius_px));
  job.stride = (job.width + kVector - 1) / kVector * kVector;
  job.uniforms.u_aspect = aspect;
  const std::size_t pixels = static_cast<std::size_t>(job.stride) * static_cast<std::size_t>(job.height);
  self.under_.resize(pixels);
  self.shown_.resize(pixels);
  self.picture_ = gles::make_texture({GL_RGBA8, job.width, job.height});
  auto framebuffer = gles::make_framebuffer(self.picture_.id());
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  self.framebuffer_ = std::move(*framebuffer);
  return self;
}

void ProcessorInset::lay_on(GLuint framebuffer) noexcept {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ROW_LENGTH, job_.stride);
  glReadPixels(x_, y_, job_.width, job_.height, GL_RGBA, GL_UNSIGNED_BYTE, under_.data());
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

void ProcessorInset::draw(const gles::PicturePlanes& picture, const CircularMask& mask,
                          GLuint into) noexcept {
  job_.picture = picture;
  job_.uniforms.u_circle = {mask.cx_px, mask.cy_px, mask.radius_px, 0};
  job_.uniforms.u_picture_size = {picture.luma.width, picture.luma.height};
  job_.under = under_.data();
  job_.shown = shown_.data();
  draw_inset(job_);
  glBindTexture(GL_TEXTURE_2D, picture_.id());
  glPixelStorei(GL_UNPACK_ROW_LENGTH, job_.stride);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, job_.width, job_.height, GL_RGBA, GL_UNSIGNED_BYTE, shown_.data());
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, into);
  glBlitFramebuffer(0, 0, job_.width, job_.height, x_, y_, x_ + job_.width, y_ + job_.height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, into);
}

}  // namespace orcart
