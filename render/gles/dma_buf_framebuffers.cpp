// EGL_EXT_image_dma_buf_import, with the modifier where there is one.
#include "render/gles/dma_buf_framebuffers.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <GLES2/gl2ext.h>

namespace orcart::gles {
namespace {

constexpr std::uint64_t kNoModifier = 0x00FF'FFFF'FFFF'FFFF;  // DRM_FORMAT_MOD_INVALID: the driver knows

struct Calls {
  PFNEGLCREATEIMAGEKHRPROC create = nullptr;
  PFNEGLDESTROYIMAGEKHRPROC destroy = nullptr;
  PFNGLEGLIMAGETARGETTEXTURE2DOESPROC bind = nullptr;
};

const Calls& calls() noexcept {
  static const Calls found{
      reinterpret_cast<PFNEGLCREATEIMAGEKHRPROC>(eglGetProcAddress("eglCreateImageKHR")),
      reinterpret_cast<PFNEGLDESTROYIMAGEKHRPROC>(eglGetProcAddress("eglDestroyImageKHR")),
      reinterpret_cast<PFNGLEGLIMAGETARGETTEXTURE2DOESPROC>(
          eglGetProcAddress("glEGLImageTargetTexture2DOES"))};
  return found;
}

EGLImageKHR import(const ImagePlane& plane, const DmaBufView& view) noexcept {
  EGLint wanted[] = {EGL_WIDTH,
                     view.width_px,
                     EGL_HEIGHT,
                     view.height_px,
                     EGL_LINUX_DRM_FOURCC_EXT,
                     static_cast<EGLint>(view.drm_format),
                     EGL_DMA_BUF_PLANE0_FD_EXT,
                     plane.dma_buf_fd,
                     EGL_DMA_BUF_PLANE0_OFFSET_EXT,
                     static_cast<EGLint>(plane.offset_bytes),
                     EGL_DMA_BUF_PLANE0_PITCH_EXT,
                     static_cast<EGLint>(plane.stride_bytes),
                     EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT,
                     static_cast<EGLint>(view.modifier & 0xFFFF'FFFFU),
                     EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT,
                     static_cast<EGLint>(view.modifier >> 32),
                     EGL_NONE};
  constexpr std::size_t kModifierAt = 12;
  if (view.modifier == kNoModifier || view.modifier == 0) wanted[kModifierAt] = EGL_NONE;  // linear by stride
  return calls().create(eglGetCurrentDisplay(), EGL_NO_CONTEXT, EGL_LINUX_DMA_BUF_EXT, nullptr, wanted);
}

/// No texture where this EGL cannot import it.
Texture texture_over(const ImagePlane& plane, const DmaBufView& view) noexcept {
  if (calls().create == nullptr || calls().bind == nullptr) return {};
  const EGLImageKHR imported = import(plane, view);
  if (imported == EGL_NO_IMAGE_KHR) return {};
  GLuint name = 0;
  glGenTextures(1, &name);
  Texture texture(name);
  glBindTexture(GL_TEXTURE_2D, name);
  calls().bind(GL_TEXTURE_2D, imported);
  calls().destroy(eglGetCurrentDisplay(), imported);  // the texture keeps the memory
  return texture;
}

}  // namespace

DmaBufFramebuffers::DmaBufFramebuffers(std::size_t most) : known_(most) {}

GLuint DmaBufFramebuffers::over(const ImagePlane& plane, const DmaBufView& view) noexcept {
  if (plane.dma_buf_fd < 0 || plane.dma_buf_id == 0) return 0;
  for (const Known& each : known_)
    if (each.buffer_id == plane.dma_buf_id && each.offset_bytes == plane.offset_bytes &&
        each.drm_format == view.drm_format)
      return each.framebuffer.id();
  Texture texture = texture_over(plane, view);
  if (!texture) return 0;
  auto framebuffer = make_framebuffer(texture.id());
  if (!framebuffer) return 0;
  Known& place = known_[next_++ % known_.size()];
  place = {.buffer_id = plane.dma_buf_id,
           .offset_bytes = plane.offset_bytes,
           .drm_format = view.drm_format,
           .texture = std::move(texture),
           .framebuffer = std::move(*framebuffer)};
  return place.framebuffer.id();
}

}  // namespace orcart::gles
