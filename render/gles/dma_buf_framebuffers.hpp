// Framebuffers over memory of another driver: a panel's buffer is drawn into and a camera's is read without
// the CPU.
#pragma once

#include <cstddef>
#include <vector>

#include "realtime/base/image.hpp"
#include "render/gles/objects.hpp"

namespace orcart::gles {

/// How a plane's bytes are seen, whatever picture they are of.
struct DmaBufView {
  std::uint32_t drm_format = 0;  ///< DRM_FORMAT_*, as a PixelFormat where it has one
  int width_px = 0, height_px = 0;
  std::uint64_t modifier = 0;  ///< DRM format modifier; 0 is linear
};

/// Remembers the newest few, so that a device's buffers are imported once. The thread whose context is
/// current, and no other.
class DmaBufFramebuffers {
 public:
  explicit DmaBufFramebuffers(std::size_t most);
  DmaBufFramebuffers(DmaBufFramebuffers&& other) noexcept = default;
  DmaBufFramebuffers& operator=(DmaBufFramebuffers&& other) noexcept = default;

  /// Row 0 is the plane's first. 0 where the plane is in no dma-buf, or EGL cannot import it or draw into it.
  GLuint over(const ImagePlane& plane, const DmaBufView& view) noexcept;
  std::size_t imported() const noexcept { return next_; }  ///< how many, ever

 private:
  struct Known {
    std::uint64_t buffer_id = 0;
    std::uint32_t offset_bytes = 0, drm_format = 0;
    Texture texture;
    Framebuffer framebuffer;
  };
  std::vector<Known> known_;
  std::size_t next_ = 0;
};

}  // namespace orcart::gles
