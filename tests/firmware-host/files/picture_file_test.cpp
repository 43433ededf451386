// Pictures of every common encoding come out as RGBA; damaged ones are refused with their name.
#include "firmware-host/files/picture_file.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/files/picture_samples.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

using Rgba = std::vector<std::uint8_t>;

Rgba rgba_of(const std::string& bytes) {
  const TemporaryFolder folder;
  const auto picture = read_picture(folder.write("picture", bytes));
  EXPECT_TRUE(picture) << picture.error().message;
  return picture ? picture->rgba : Rgba{};
}

std::string error_of(const std::string& bytes) {
  const TemporaryFolder folder;
  const auto picture = read_picture(folder.write("picture", bytes));
  EXPECT_FALSE(picture);
  if (picture) return "";
  const std::string& message = picture.error().message;
  EXPECT_NE(message.find("picture"), std::string::npos) << message;
  return message;
}

TEST(PictureFile, WritesWhatItReads) {
  const TemporaryFolder folder;
  const Rgba rgba = {1, 2, 3, 0, 250, 128, 7, 255};
  ASSERT_TRUE(write_png(folder / "a.png", 2, 1, rgba, Alpha::keep));
  const auto picture = read_picture(folder / "a.png");
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->width_px, 2);
  EXPECT_EQ(picture->height_px, 1);
  EXPECT_EQ(picture->rgba, rgba);
}

TEST(PictureFile, DropsAlphaWhereAsked) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", 1, 1, Rgba{9, 8, 7, 6}));
  EXPECT_EQ(read_picture(folder / "a.png")->rgba, (Rgba{9, 8, 7, 255}));
}

TEST(PictureFile, DescribesItselfToTheRenderer) {
  Picture picture{.width_px = 3, .height_px = 2, .rgba = Rgba(24)};
  const ImageDescriptor image = picture.descriptor();
  EXPECT_EQ(image.format, PixelFormat::rgba8888);
  EXPECT_EQ(image.planes[0].stride_bytes, 12U);
  EXPECT_EQ(image.planes[0].data, reinterpret_cast<std::byte*>(picture.rgba.data()));
}

TEST(PictureFile, ReadsGrey) {
  EXPECT_EQ(rgba_of(png_of({.color_type = PNG_COLOR_TYPE_GRAY}, 2, {{10, 200}})),
            (Rgba{10, 10, 10, 255, 200, 200, 200, 255}));
}

TEST(PictureFile, ReadsSixteenBitsAsTheSameBrightnessAsEight) {
  const PngKind kind{.bit_depth = 16};
  EXPECT_EQ(rgba_of(png_of(kind, 1, {{0x80, 0x80, 0x40, 0x40, 0xFF, 0xFF}})), (Rgba{0x80, 0x40, 0xFF, 255}));
}

TEST(PictureFile, ReadsAPalette) {
  const PngKind kind{.bit_depth = 1, .color_type = PNG_COLOR_TYPE_PALETTE};
  EXPECT_EQ(rgba_of(png_of(kind, 2, {{0b0100'0000}})), (Rgba{255, 0, 0, 255, 0, 255, 0, 255}));
}

TEST(PictureFile, ReadsAlphaAndInterlacedRows) {
  const PngKind kind{.color_type = PNG_COLOR_TYPE_RGB_ALPHA, .interlace = PNG_INTERLACE_ADAM7};
  EXPECT_EQ(rgba_of(png_of(kind, 1, {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}})),
            (Rgba{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

TEST(PictureFile, ReadsJpeg) {
  const Rgba rgba = rgba_of(jpeg_of(16, 16, {200, 40, 90}));
  ASSERT_EQ(rgba.size(), 1024U);
  EXPECT_NEAR(rgba[0], 200, 2);
  EXPECT_NEAR(rgba[1], 40, 2);
  EXPECT_NEAR(rgba[2], 90, 2);
  EXPECT_EQ(rgba[3], 255);
  EXPECT_EQ(rgba_of(jpeg_of(1, 1, {77})), (Rgba{77, 77, 77, 255}));
}

TEST(PictureFile, RefusesEveryPngCutShort) {
  const std::string whole = png_of({}, 2, {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}});
  const std::size_t end_chunk = 12;  // its absence costs no pixel
  for (std::size_t length = 0; length < whole.size() - end_chunk; ++length)
    EXPECT_NE(error_of(whole.substr(0, length)), "") << length;
}

TEST(PictureFile, RefusesEveryJpegCutShort) {
  const std::string whole = jpeg_of(8, 8, {200, 40, 90});
  const std::size_t end_mark = 2;
  for (std::size_t length = 0; length < whole.size() - end_mark; ++length)
    EXPECT_NE(error_of(whole.substr(0, length)), "") << length;
}

TEST(PictureFile, RefusesWhatIsNoPicture) {
  EXPECT_NE(error_of("").find("neither PNG nor JPEG"), std::string::npos);
  EXPECT_NE(error_of("GIF89a...").find("neither PNG nor JPEG"), std::string::npos);
  EXPECT_NE(read_picture("/no/such/picture.png").error().message.find("/no/such/picture.png"),
            std::string::npos);
  EXPECT_FALSE(read_picture("/tmp"));
}

TEST(PictureFile, RefusesAPngThatIsTooLarge) {
  std::string bytes =
      png_of({.color_type = PNG_COLOR_TYPE_GRAY}, 16'385, {std::vector<std::uint8_t>(16'385)});
  EXPECT_NE(error_of(bytes).find("16385x1 pixels; up to 16384 a side"), std::string::npos);
  EXPECT_NE(error_of(jpeg_of(16'385, 1, {1})).find("larger than 16384"), std::string::npos);
}

TEST(PictureFile, WritesNothingWhereItCannot) {
  const TemporaryFolder folder;
  EXPECT_FALSE(write_png(folder / "a.png", 2, 1, Rgba(4)));
  EXPECT_FALSE(write_png(folder / "a.png", 0, 0, Rgba{}));
  EXPECT_FALSE(write_png(folder / "no/folder.png", 1, 1, Rgba(4)));
  EXPECT_EQ(folder.count(), 0U);
}

}  // namespace
}  // namespace orcart
