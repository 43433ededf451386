// EGL_EXT_image_dma_buf_import, with the modifier where there is one.
#include "render/gles/shared_target.hpp"

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

EGLImageKHR import(const ImageDescriptor& image) noexcept {
  const ImagePlane& plane = image.planes[0];
  EGLint wanted[] = {EGL_WIDTH,
                     image.width_px,
                     EGL_HEIGHT,
                     image.height_px,
                     EGL_LINUX_DRM_FOURCC_EXT,
                     static_cast<EGLint>(image.format),
                     EGL_DMA_BUF_PLANE0_FD_EXT,
                     plane.dma_buf_fd,
                     EGL_DMA_BUF_PLANE0_OFFSET_EXT,
                     static_cast<EGLint>(plane.offset_bytes),
                     EGL_DMA_BUF_PLANE0_PITCH_EXT,
                     static_cast<EGLint>(plane.stride_bytes),
                     EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT,
                     static_cast<EGLint>(image.modifier & 0xFFFF'FFFFU),
                     EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT,
                     static_cast<EGLint>(image.modifier >> 32),
                     EGL_NONE};
  constexpr std::size_t kModifierAt = 12;
  if (image.modifier == kNoModifier || image.modifier == 0)
    wanted[kModifierAt] = EGL_NONE;  // linear by stride
  return calls().create(eglGetCurrentDisplay(), EGL_NO_CONTEXT, EGL_LINUX_DMA_BUF_EXT, nullptr, wanted);
}

}  // namespace

GLuint SharedTargets::framebuffer_of(const ImageDescriptor& image) noexcept {
  const int dma_buf = image.planes[0].dma_buf_fd;
  if (dma_buf < 0 || image.format != PixelFormat::xrgb8888 || calls().create == nullptr ||
      calls().bind == nullptr)
    return 0;
  for (const Target& known : targets_)
    if (known.dma_buf == dma_buf) return known.framebuffer.id();
  const EGLImageKHR imported = import(image);
  if (imported == EGL_NO_IMAGE_KHR) return 0;
  GLuint name = 0;
  glGenTextures(1, &name);
  Texture texture(name);
  glBindTexture(GL_TEXTURE_2D, name);
  calls().bind(GL_TEXTURE_2D, imported);
  calls().destroy(eglGetCurrentDisplay(), imported);  // the texture keeps the memory
  auto framebuffer = make_framebuffer(name);
  if (!framebuffer) return 0;
  Target& place = targets_[next_++ % targets_.size()];
  place.dma_buf = dma_buf;
  place.texture = std::move(texture);
  place.framebuffer = std::move(*framebuffer);
  return place.framebuffer.id();
}

}  // namespace orcart::gles
