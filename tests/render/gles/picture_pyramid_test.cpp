// Means of 2 x 2 texels to the byte, at widths that are no multiple of a vector.
#include "render/gles/picture_pyramid.hpp"

#include <random>

#include <gtest/gtest.h>

namespace orcart::gles {
namespace {

class Pyramid : public ::testing::TestWithParam<int> {};

TEST_P(Pyramid, IsTheRoundedMeanOfFourTexelsAtEveryLevelAndWidth) {
  const int channels = GetParam();
  std::minstd_rand random(7);
  for (const int width : {4, 12, 36, 100, 644}) {
    constexpr int kHeight = 8, kPadding = 5;
    const std::size_t stride = static_cast<std::size_t>(width * channels + kPadding);
    std::vector<std::uint8_t> picture(stride * kHeight);
    for (std::uint8_t& byte : picture) byte = static_cast<std::uint8_t>(random());
    PicturePyramid pyramid(width, kHeight, channels, 2);
    pyramid.build({picture.data(), stride, width, kHeight});

    const std::uint8_t* from = picture.data();
    std::size_t from_stride = stride;
    for (int level = 1; level <= 2; ++level) {
      const int columns = (width >> level) * channels;
      for (int y = 0; y < kHeight >> level; ++y)
        for (int x = 0; x < columns; ++x) {
          const auto* corner = from + static_cast<std::size_t>(2 * y) * from_stride +
                               2 * (x / channels) * channels + x % channels;
          const int sum = corner[0] + corner[channels] + corner[from_stride] +
                          corner[from_stride + static_cast<std::size_t>(channels)];
          ASSERT_EQ(pyramid.level(level)[y * columns + x], (sum + 2) / 4)
              << width << ' ' << level << ' ' << y << ' ' << x;
        }
      from = pyramid.level(level);
      from_stride = static_cast<std::size_t>(columns);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Channels, Pyramid, ::testing::Values(1, 2, 4));

TEST(ExactHalvings, StopAtTheFirstOddSide) {
  EXPECT_EQ(exact_halvings(1920, 1080, 4), 3);
  EXPECT_EQ(exact_halvings(640, 480, 4), 4);
  EXPECT_EQ(exact_halvings(641, 480, 4), 0);
}

}  // namespace
}  // namespace orcart::gles
