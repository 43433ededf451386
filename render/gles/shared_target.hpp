// Framebuffers over pictures that live in dma-bufs: what is drawn is in the other's memory, without a copy.
#pragma once

#include <array>
#include <cstddef>

#include "realtime/base/image.hpp"
#include "render/gles/objects.hpp"

namespace orcart::gles {

/// Remembers the newest few pictures by their dma-buf, so that a panel's buffers are imported once. The
/// thread whose context is current, and no other.
class SharedTargets {
 public:
  SharedTargets() = default;
  SharedTargets(SharedTargets&& other) noexcept = default;
  SharedTargets& operator=(SharedTargets&& other) noexcept = default;

  /// A framebuffer over an xrgb8888 picture in a dma-buf; 0 where it is none or EGL cannot import it. Row 0
  /// is the picture's top.
  GLuint framebuffer_of(const ImageDescriptor& image) noexcept;

 private:
  struct Target {
    int dma_buf = -1;
    Texture texture;
    Framebuffer framebuffer;
  };
  std::array<Target, 4> targets_;
  std::size_t next_ = 0;
};

}  // namespace orcart::gles
