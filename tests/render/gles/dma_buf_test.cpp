// What is drawn into a panel's own buffer is in that buffer, and what a camera wrote into one is what is
// painted from: on a display card that exports dma-bufs, e.g. vkms.
#include "render/gles/dma_buf_framebuffers.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <random>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "board/linux/kms/drm_scan_out.hpp"
#include "board/linux/v4l2/v4l2_frame_source.hpp"
#include "render/egl/context.hpp"
#include "render/gles/picture_texture.hpp"
#include "tests/hardware/environment.hpp"

namespace orcart::gles {
namespace {

constexpr auto kPanel = static_cast<std::uint32_t>(PixelFormat::xrgb8888);

TEST(DmaBufFramebuffers, RefuseWhatIsInNoDmaBuf) {
  const auto context = GlContext::create();
  ASSERT_TRUE(context) << context.error().message;
  DmaBufFramebuffers framebuffers(1);
  std::uint32_t pixel = 0;
  const ImageDescriptor image =
      packed_image(reinterpret_cast<std::byte*>(&pixel), PixelFormat::xrgb8888, 1, 1);
  EXPECT_EQ(framebuffers.over(image.planes[0], {.drm_format = kPanel, .width_px = 1, .height_px = 1}), 0u);
}

/// A card whose buffers EGL imports, and the first of them.
class DmaBuf : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto card = testing::device_named("ORCART_TEST_PANEL");
    if (!card) GTEST_SKIP() << testing::not_set("ORCART_TEST_PANEL");
    auto opened = DrmScanOut::open({.device = *card});
    ASSERT_TRUE(opened) << opened.error().message;
    scan_out = std::move(*opened);
    if (auto made = scan_out->make_buffers(PanelBuffers::gpu); !made) GTEST_SKIP() << made.error().message;
    auto made = GlContext::create({.gbm_device = scan_out->gbm()});
    ASSERT_TRUE(made) << made.error().message;
    context = std::make_unique<GlContext>(std::move(*made));
    if (!context->can_import_dma_buf()) GTEST_SKIP() << "this EGL imports no dma-bufs";
    image = scan_out->buffer(0);
    const std::size_t size =
        std::size_t{image.planes[0].stride_bytes} * static_cast<std::size_t>(image.height_px);
    void* mapped = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, image.planes[0].dma_buf_fd, 0);
    ASSERT_NE(mapped, MAP_FAILED);
    memory = {static_cast<std::byte*>(mapped), size};
  }
  void TearDown() override {
    if (!memory.empty()) ::munmap(memory.data(), memory.size());
  }

  std::unique_ptr<DrmScanOut> scan_out;
  std::unique_ptr<GlContext> context;
  ImageDescriptor image;
  std::span<std::byte> memory;  ///< the buffer's
};

TEST_F(DmaBuf, IsDrawnIntoAndShown) {
  DmaBufFramebuffers framebuffers(4);
  const DmaBufView view{.drm_format = kPanel,
                        .width_px = image.width_px,
                        .height_px = image.height_px,
                        .modifier = image.modifier};
  const GLuint framebuffer = framebuffers.over(image.planes[0], view);
  ASSERT_NE(framebuffer, 0u);
  EXPECT_EQ(framebuffers.over(image.planes[0], view), framebuffer) << "imported once";
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

  const auto* top = reinterpret_cast<const std::uint32_t*>(memory.data());
  const auto* below = top + image.planes[0].stride_bytes / 4;
  EXPECT_EQ(top[5] & 0xFFFFFFu, 0x0000FFu) << "row 0 is the panel's top";
  EXPECT_EQ(below[5] & 0xFFFFFFu, 0xFF0000u);
  EXPECT_TRUE(scan_out->set_mode(0)) << "and the card shows it";
}

/// Every level of both textures that shaders look into, as RGBA.
std::vector<std::vector<std::uint8_t>> texels_of(const PictureTexture& picture, int width_px, int height_px) {
  picture.bind({-1, -1, -1, -1}, 0);
  std::vector<std::vector<std::uint8_t>> levels;
  for (const GLenum unit : {GL_TEXTURE0, GL_TEXTURE1}) {
    GLint texture = 0, finest = 0;
    glActiveTexture(unit);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture);
    glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_IMMUTABLE_LEVELS, &finest);
    const int width = unit == GL_TEXTURE1 ? width_px / 2 : width_px;
    for (int level = 0; level < finest; ++level) {
      const auto framebuffer = make_framebuffer(static_cast<GLuint>(texture));
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                             static_cast<GLuint>(texture), level);
      auto& texels =
          levels.emplace_back(4u * static_cast<std::size_t>((width >> level) * (height_px >> level)));
      glReadPixels(0, 0, width >> level, height_px >> level, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    }
  }
  return levels;
}

/// The finest levels to the byte, the others give or take a driver's rounding.
void expect_same_textures(const PictureTexture& one, const PictureTexture& other, int width_px,
                          int height_px) {
  const auto all = texels_of(one, width_px, height_px), expected = texels_of(other, width_px, height_px);
  ASSERT_EQ(all.size(), expected.size());
  ASSERT_GE(all.size(), 4u);
  for (std::size_t level = 0; level < all.size(); ++level) {
    int most = 0;
    for (std::size_t i = 0; i < all[level].size(); ++i)
      most = std::max(most, std::abs(all[level][i] - expected[level][i]));
    EXPECT_LE(most,
              level == 0 || level == all.size() / 2 ? 0 : 1 + static_cast<int>(level % (all.size() / 2)))
        << level;
  }
}

TEST_F(DmaBuf, IsCopiedByTheGpuAsByTheCpu) {
  DmaBufFramebuffers framebuffers(1);
  const GLuint buffer = framebuffers.over(
      image.planes[0], {.drm_format = kPanel, .width_px = image.width_px, .height_px = image.height_px});
  ASSERT_NE(buffer, 0u);
  std::minstd_rand random(3);
  const auto fill = [&] {
    const Texture noise = make_texture({GL_RGBA8, image.width_px, image.height_px});
    std::vector<std::uint32_t> texels(static_cast<std::size_t>(image.width_px * image.height_px));
    for (std::uint32_t& texel : texels) texel = static_cast<std::uint32_t>(random());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image.width_px, image.height_px, GL_RGBA, GL_UNSIGNED_BYTE,
                    texels.data());
    const auto from = make_framebuffer(noise.id());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from->id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, buffer);
    glBlitFramebuffer(0, 0, image.width_px, image.height_px, 0, 0, image.width_px, image.height_px,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glFinish();
  };
  for (const PixelFormat format : {PixelFormat::yuyv, PixelFormat::nv12}) {
    fill();
    ImageDescriptor picture = packed_image(memory.data(), format, 640, 480);
    picture.plane_count = format == PixelFormat::nv12 ? 2 : 1;
    for (ImagePlane& plane : picture.planes) {
      plane.stride_bytes = image.planes[0].stride_bytes;
      plane.dma_buf_fd = image.planes[0].dma_buf_fd;
      plane.dma_buf_id = image.planes[0].dma_buf_id;
    }
    if (format == PixelFormat::nv12) picture.planes[1].offset_bytes = 480 * image.planes[0].stride_bytes;
    PictureTexture by_gpu(640, 480, PictureCopy::gpu), by_cpu(640, 480);
    ASSERT_TRUE(by_gpu.upload(picture));
    ASSERT_TRUE(by_cpu.upload(picture));
    EXPECT_EQ(by_gpu.copy(), PictureCopy::gpu);
    expect_same_textures(by_gpu, by_cpu, 640, 480);
    fill();
    ASSERT_TRUE(by_gpu.upload(picture)) << "the next picture in the same buffer";
    ASSERT_TRUE(by_cpu.upload(picture));
    expect_same_textures(by_gpu, by_cpu, 640, 480);
  }
}

// A camera's driver exports memory that the card may not be able to read: then the CPU copies.
TEST_F(DmaBuf, OfACameraIsCopiedByTheGpuOrElseByTheCpu) {
  const auto device = testing::device_named("ORCART_TEST_CAMERA");
  if (!device) GTEST_SKIP() << testing::not_set("ORCART_TEST_CAMERA");
  RealClock clock;
  const CameraWish wish{.device = *device, .width_px = 640, .height_px = 480, .rate_hz = 25};
  auto camera = V4l2FrameSource::open({.wish = wish, .clock = clock});
  ASSERT_TRUE(camera) << camera.error().message;
  ASSERT_TRUE((*camera)->exports_dma_bufs());
  ASSERT_TRUE((*camera)->start());
  PictureTexture by_gpu(640, 480, PictureCopy::gpu), by_cpu(640, 480);
  for (int frames = 0; frames < 3;) {
    (*camera)->wait(clock.now() + 5s);
    const auto frame = (*camera)->take();
    if (!frame) continue;
    ASSERT_GT(frame->image.planes[0].dma_buf_id, 0u);
    ASSERT_TRUE(by_gpu.upload(frame->image));
    ASSERT_TRUE(by_cpu.upload(frame->image));
    expect_same_textures(by_gpu, by_cpu, 640, 480);
    (*camera)->give_back(frame->index);
    ++frames;
  }
  (*camera)->stop();
  std::cout << "copied by the " << (by_gpu.copy() == PictureCopy::gpu ? "GPU\n" : "CPU\n");
}

}  // namespace
}  // namespace orcart::gles
