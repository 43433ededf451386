// Good pictures come out right; cut, garbled, foreign and endless ones are damaged and harm nothing.
#include "board/linux/v4l2/mjpeg_decoder.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/board/linux/v4l2/jpeg_samples.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

class MjpegDecoderTest : public ::testing::Test {
 protected:
  MjpegDecoderTest() {
    auto made = MjpegDecoder::create(64, 48);
    EXPECT_TRUE(made);
    decoder.emplace(std::move(*made));
  }
  bool decode(std::span<const std::byte> jpeg) {
    const auto decoded = decoder->decode(jpeg, image);
    EXPECT_TRUE(decoded || decoded.error() == PortFault::damaged);
    return decoded.has_value();
  }
  int channel(int x, int y, int c) const {
    return std::to_integer<int>(pixels[static_cast<std::size_t>((y * 64 + x) * 4 + c)]);
  }
  static int ramp(int at, int size) { return at * 255 / size; }
  void expect_ramp() const {
    for (const auto& [x, y] : {std::pair{0, 0}, {63, 0}, {31, 24}, {5, 47}, {63, 47}}) {
      EXPECT_NEAR(channel(x, y, 0), ramp(x, 64), 12) << x << "," << y;
      EXPECT_NEAR(channel(x, y, 1), ramp(y, 48), 12) << x << "," << y;
      EXPECT_NEAR(channel(x, y, 2), 64, 16) << x << "," << y;
      EXPECT_EQ(channel(x, y, 3), 255);
    }
  }

  std::optional<MjpegDecoder> decoder;
  std::vector<std::byte> pixels = std::vector<std::byte>(64 * 48 * 4);
  ImageDescriptor image = packed_image(pixels.data(), PixelFormat::rgba8888, 64, 48);
};

TEST_F(MjpegDecoderTest, DecodesEverySubsamplingThatCamerasSend) {
  for (const auto& [h, v] : {std::pair{1, 1}, {2, 1}, {2, 2}}) {
    std::ranges::fill(pixels, std::byte{0});
    ASSERT_TRUE(decode(jpeg_ramp({.chroma_h = h, .chroma_v = v})));
    expect_ramp();
  }
}

TEST_F(MjpegDecoderTest, CallsACutPictureDamagedWhereverItIsCut) {
  const auto whole = jpeg_ramp({});
  for (std::size_t length = 0; length + 2 < whole.size(); ++length)
    EXPECT_FALSE(decode(std::span(whole).first(length))) << length;
  EXPECT_TRUE(decode(whole));
  expect_ramp();
}

TEST_F(MjpegDecoderTest, PassesOverStrayBytesBeforeAMarkerAsManyCamerasSendThem) {
  auto padded = jpeg_ramp({.restart_interval = 4});
  ASSERT_TRUE(decode(padded));
  const auto expected = pixels;
  int markers = 0;
  for (std::size_t i = 0; i + 1 < padded.size(); ++i) {  // RST0 to RST7, and the end
    const auto code = std::to_integer<unsigned>(padded[i + 1]);
    if (padded[i] != std::byte{0xFF} || code < 0xD0 || code > 0xD9 || code == 0xD8) continue;
    padded.insert(padded.begin() + static_cast<std::ptrdiff_t>(i), 3, std::byte{0x5A});
    i += 4;
    ++markers;
  }
  ASSERT_GE(markers, 6);
  std::ranges::fill(pixels, std::byte{0});
  ASSERT_TRUE(decode(padded));
  EXPECT_EQ(pixels, expected);
}

TEST_F(MjpegDecoderTest, CallsAPictureThatLacksARestartMarkerDamaged) {
  auto jpeg = jpeg_ramp({.restart_interval = 4});
  for (std::size_t i = 0; i + 1 < jpeg.size(); ++i)
    if (jpeg[i] == std::byte{0xFF} && jpeg[i + 1] == std::byte{0xD2}) jpeg[i + 1] = std::byte{0xD5};
  EXPECT_FALSE(decode(jpeg));
}

TEST_F(MjpegDecoderTest, SurvivesGarbageOfEveryKind) {
  std::mt19937 random(7);
  std::vector<std::byte> noise(4096);
  for (auto& byte : noise) byte = static_cast<std::byte>(random());
  EXPECT_FALSE(decode(noise));
  const auto whole = jpeg_ramp({});
  for (int i = 0; i < 2000; ++i) {
    auto garbled = whole;
    for (int k = 0; k < 3; ++k) garbled[random() % garbled.size()] = static_cast<std::byte>(random());
    (void)decode(garbled);
  }
  ASSERT_TRUE(decode(whole));
  expect_ramp();
}

TEST_F(MjpegDecoderTest, RefusesAnotherSizeAndAProgressivePicture) {
  EXPECT_FALSE(decode(jpeg_ramp({.width_px = 32})));
  EXPECT_FALSE(decode(jpeg_ramp({.progressive = true}))) << "it would want memory for the whole picture";
  EXPECT_TRUE(decode(jpeg_ramp({})));
}

TEST_F(MjpegDecoderTest, UsesTheStandardTablesWhereMotionJpegLeavesThemOut) {
  auto jpeg = jpeg_ramp({});
  for (std::size_t i = 0; i + 4 < jpeg.size();) {  // takes every DHT segment out
    if (jpeg[i] == std::byte{0xFF} && jpeg[i + 1] == std::byte{0xC4}) {
      const auto length =
          2 + (std::to_integer<std::size_t>(jpeg[i + 2]) << 8 | std::to_integer<std::size_t>(jpeg[i + 3]));
      jpeg.erase(jpeg.begin() + static_cast<std::ptrdiff_t>(i),
                 jpeg.begin() + static_cast<std::ptrdiff_t>(i + length));
    } else {
      ++i;
    }
  }
  ASSERT_LT(jpeg.size(), jpeg_ramp({}).size() - 400);
  auto fresh = MjpegDecoder::create(64, 48);
  ASSERT_TRUE(fresh);
  ASSERT_TRUE(fresh->decode(jpeg, image));
  expect_ramp();
}

TEST_F(MjpegDecoderTest, RefusesATargetOfAnotherFormat) {
  image.format = PixelFormat::yuyv;
  EXPECT_EQ(decoder->decode(jpeg_ramp({}), image).error(), PortFault::unsupported);
}

TEST_F(MjpegDecoderTest, AllocatesNothingWhetherThePictureIsGoodOrNot) {
  const auto good = jpeg_ramp({}), progressive = jpeg_ramp({.progressive = true});
  EXPECT_TRUE(zero_allocation([&] {
    (void)decoder->decode(good, image);
    (void)decoder->decode(progressive, image);
    (void)decoder->decode(std::span(good).first(300), image);
  }));
}

TEST_F(MjpegDecoderTest, HasRoomForTheLargestPictures) {
  auto large = MjpegDecoder::create(1920, 1080);
  ASSERT_TRUE(large);
  std::vector<std::byte> all(1920 * 1080 * 4);
  for (const auto& [h, v] : {std::pair{1, 1}, {2, 2}})
    EXPECT_TRUE(large->decode(jpeg_ramp({.width_px = 1920, .height_px = 1080, .chroma_h = h, .chroma_v = v}),
                              packed_image(all.data(), PixelFormat::rgba8888, 1920, 1080)));
}

}  // namespace
}  // namespace orcart::testing
