// The sampled grid on pictures whose figures are known.
#include "firmware-host/camera/picture_samples.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace orcart {
namespace {

class EveryFormat : public ::testing::TestWithParam<PixelFormat> {};

/// Luma (or green) 200 everywhere, every other byte 7.
std::vector<std::byte> even_picture(PixelFormat format, int width_px, int height_px) {
  std::vector<std::byte> bytes(packed_bytes(format, width_px, height_px), std::byte{7});
  const auto pixels = static_cast<std::size_t>(width_px * height_px);
  std::size_t step = 1, first = 0;
  if (format == PixelFormat::yuyv) step = 2;
  if (format == PixelFormat::uyvy) step = 2, first = 1;
  if (format == PixelFormat::rgba8888 || format == PixelFormat::xrgb8888) step = 4, first = 1;
  for (std::size_t i = 0; i < pixels; ++i) bytes[i * step + first] = std::byte{200};
  return bytes;
}

TEST_P(EveryFormat, YieldsItsLuma) {
  auto bytes = even_picture(GetParam(), 160, 120);
  const PictureSamples samples = sample_picture(packed_image(bytes.data(), GetParam(), 160, 120));
  EXPECT_TRUE(samples.known);
  EXPECT_EQ(samples.mean_luma, 200);
  EXPECT_EQ(samples.dark_share, 0);
  EXPECT_EQ(samples.bright_share, 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         ::testing::Values(PixelFormat::yuyv, PixelFormat::uyvy, PixelFormat::nv12,
                                           PixelFormat::gray8, PixelFormat::rgba8888, PixelFormat::xrgb8888));

TEST(PictureSamples, TellsDarkFromBright) {
  std::vector<std::byte> bytes(64 * 48, std::byte{0});
  for (std::size_t i = 0; i < 64 * 12; ++i) bytes[i] = std::byte{255};
  const PictureSamples samples = sample_picture(packed_image(bytes.data(), PixelFormat::gray8, 64, 48));
  EXPECT_NEAR(samples.bright_share, 0.25, 0.01);
  EXPECT_NEAR(samples.dark_share, 0.75, 0.01);
}

TEST(PictureSamples, ChangeWithOnePixelOfTheGrid) {
  std::vector<std::byte> bytes(64 * 48, std::byte{50});
  const ImageDescriptor image = packed_image(bytes.data(), PixelFormat::gray8, 64, 48);
  const PictureSamples before = sample_picture(image);
  bytes[0] = std::byte{51};
  EXPECT_NE(sample_picture(image).checksum, before.checksum);
}

TEST(PictureSamples, StayInsidePicturesOfEverySmallSize) {
  for (int width = 1; width < 70; ++width)
    for (int height : {1, 2, 7, 47, 48, 49}) {
      std::vector<std::byte> bytes(packed_bytes(PixelFormat::gray8, width, height), std::byte{9});
      EXPECT_EQ(sample_picture(packed_image(bytes.data(), PixelFormat::gray8, width, height)).mean_luma, 9);
    }
}

TEST(PictureSamples, AreUnknownWithoutPixels) {
  EXPECT_FALSE(sample_picture({}).known);
  EXPECT_FALSE(sample_picture({.width_px = 640, .height_px = 480, .format = PixelFormat::nv12}).known);
}

}  // namespace
}  // namespace orcart
