// A GL context and a picture to draw into, for tests that look at pixels.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/egl/context.hpp"
#include "render/gles/objects.hpp"

namespace orcart::testing {

/// The context that all tests of one program share; made current on the calling thread. Fails the test where
/// EGL is missing.
GlContext& shared_context();

/// RGBA8, row 0 first.
struct Pixels {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgba;

  std::array<int, 4> at(int x, int y) const;
};

/// A colour target that is bound while it lives.
class Offscreen {
 public:
  Offscreen(int width_px, int height_px);
  void clear(float r, float g, float b) const;
  Pixels read() const;

 private:
  int width_px_, height_px_;
  gles::Texture colour_;
  gles::Framebuffer framebuffer_;
};

/// Writes `name`.png into the folder that ORCART_PICTURES names; nothing where it is not set.
void keep_picture(const Pixels& pixels, const std::string& name);

}  // namespace orcart::testing
