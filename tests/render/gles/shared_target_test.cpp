// What is drawn into a panel's own buffer is in that buffer: on a display card that exports dma-bufs, e.g.
// vkms.
#include "render/gles/shared_target.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "board/linux/kms/drm_scan_out.hpp"
#include "render/egl/context.hpp"

namespace orcart::gles {
namespace {

TEST(SharedTargets, RefusesWhatIsInNoDmaBuf) {
  const auto context = GlContext::create();
  ASSERT_TRUE(context) << context.error().message;
  SharedTargets targets;
  std::uint32_t pixel = 0;
  EXPECT_EQ(
      targets.framebuffer_of(packed_image(reinterpret_cast<std::byte*>(&pixel), PixelFormat::xrgb8888, 1, 1)),
      0u);
}

TEST(SharedTargets, DrawIntoThePanelsOwnBuffer) {
  const char* card = std::getenv("ORCART_TEST_PANEL");
  if (card == nullptr || *card == '\0')
    GTEST_SKIP() << "ORCART_TEST_PANEL names no device (tests/hardware/README.md)";
  auto scan_out = DrmScanOut::open({.device = card});
  ASSERT_TRUE(scan_out) << scan_out.error().message;
  if (auto made = (*scan_out)->make_buffers(PanelBuffers::gpu); !made) GTEST_SKIP() << made.error().message;
  const auto context = GlContext::create({.gbm_device = (*scan_out)->gbm()});
  ASSERT_TRUE(context) << context.error().message;
  if (!context->can_import_dma_buf()) GTEST_SKIP() << "this EGL imports no dma-bufs";

  SharedTargets targets;
  const ImageDescriptor image = (*scan_out)->buffer(0);
  const GLuint framebuffer = targets.framebuffer_of(image);
  ASSERT_NE(framebuffer, 0u);
  EXPECT_EQ(targets.framebuffer_of(image), framebuffer) << "imported once";
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, image.width_px, image.height_px);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(1, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, image.width_px, 1);
  glClearColor(0, 0, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glFinish();

  const std::size_t size =
      std::size_t{image.planes[0].stride_bytes} * static_cast<std::size_t>(image.height_px);
  void* memory = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, image.planes[0].dma_buf_fd, 0);
  ASSERT_NE(memory, MAP_FAILED);
  const auto* top = static_cast<const std::uint32_t*>(memory);
  const auto* below = top + image.planes[0].stride_bytes / 4;
  EXPECT_EQ(top[5] & 0xFFFFFFu, 0x0000FFu) << "row 0 is the panel's top";
  EXPECT_EQ(below[5] & 0xFFFFFFu, 0xFF0000u);
  ::munmap(memory, size);
  EXPECT_TRUE((*scan_out)->set_mode(0)) << "and the card shows it";
}

}  // namespace
}  // namespace orcart::gles
