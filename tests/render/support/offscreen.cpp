// Draws into a texture and reads it back.
#include "tests/render/support/offscreen.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace orcart::testing {

GlContext& shared_context() {
  static Result<GlContext> context = GlContext::create();
  if (!context) {
    ADD_FAILURE() << context.error().message;
    std::abort();
  }
  EXPECT_TRUE(context->make_current().has_value());
  return *context;
}

std::array<int, 4> Pixels::at(int x, int y) const {
  const auto i =
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x)) * 4;
  return {rgba[i], rgba[i + 1], rgba[i + 2], rgba[i + 3]};
}

Offscreen::Offscreen(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
  shared_context();
  colour_ = gles::make_texture({GL_RGBA8, width_px, height_px, GL_NEAREST});
  auto framebuffer = gles::make_framebuffer(colour_.id());
  EXPECT_TRUE(framebuffer.has_value());
  framebuffer_ = std::move(*framebuffer);
  glViewport(0, 0, width_px, height_px);
}

void Offscreen::clear(float r, float g, float b) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glClearColor(r, g, b, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

Pixels Offscreen::read() const {
  Pixels pixels{.width_px = width_px_, .height_px = height_px_, .rgba = {}};
  pixels.rgba.resize(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_) * 4);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_px_, height_px_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.rgba.data());
  return pixels;
}

}  // namespace orcart::testing
