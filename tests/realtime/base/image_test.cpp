// The image descriptor: four-character codes, sizes and plane layout of tightly packed pictures.
#include "realtime/base/image.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(Image, FormatsAreTheKernelsFourCharacterCodes) {
  EXPECT_EQ(static_cast<std::uint32_t>(PixelFormat::yuyv), 0x56595559u);      // V4L2_PIX_FMT_YUYV
  EXPECT_EQ(static_cast<std::uint32_t>(PixelFormat::nv12), 0x3231564Eu);      // V4L2_PIX_FMT_NV12
  EXPECT_EQ(static_cast<std::uint32_t>(PixelFormat::xrgb8888), 0x34325258u);  // DRM_FORMAT_XRGB8888
}

TEST(Image, PackedBytesFollowTheSampling) {
  EXPECT_EQ(packed_bytes(PixelFormat::yuyv, 640, 480), 614'400u);
  EXPECT_EQ(packed_bytes(PixelFormat::nv12, 640, 480), 460'800u);
  EXPECT_EQ(packed_bytes(PixelFormat::rgba8888, 640, 480), 1'228'800u);
  EXPECT_EQ(packed_bytes(PixelFormat::gray8, 640, 480), 307'200u);
  EXPECT_EQ(packed_bytes(PixelFormat::none, 640, 480), 0u);
}

TEST(Image, PackedBytesOfALargePictureDoNotOverflow) {
  EXPECT_EQ(packed_bytes(PixelFormat::rgba8888, 40'000, 40'000), 6'400'000'000u);
}

TEST(Image, PackedYuyvIsOnePlaneOfTwoBytesAPixel) {
  std::byte memory[16];
  const ImageDescriptor image = packed_image(memory, PixelFormat::yuyv, 4, 2);
  EXPECT_EQ(image.plane_count, 1);
  EXPECT_EQ(image.planes[0].data, memory);
  EXPECT_EQ(image.planes[0].stride_bytes, 8u);
  EXPECT_EQ(image.planes[0].offset_bytes, 0u);
}

TEST(Image, PackedNv12HasItsChromaBehindItsLuma) {
  std::byte memory[12];
  const ImageDescriptor image = packed_image(memory, PixelFormat::nv12, 4, 2);
  EXPECT_EQ(image.plane_count, 2);
  EXPECT_EQ(image.planes[0].stride_bytes, 4u);
  EXPECT_EQ(image.planes[1].offset_bytes, 8u);
  EXPECT_EQ(image.planes[1].stride_bytes, 4u);
}

}  // namespace
}  // namespace orcart
