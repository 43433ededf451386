// Pictures come in as the sensor saw them.
#include "tools/calibration/load_picture.hpp"

#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "firmware-host/files/picture_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

/// A JPEG of 40x20 pixels, dark on the left and bright on the right, that EXIF asks to be turned by `turn`.
std::string turned_jpeg(char turn) {
  cv::Mat picture(20, 40, CV_8UC3, cv::Scalar::all(20));
  picture.colRange(20, 40).setTo(cv::Scalar::all(230));
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes);
  std::string exif(
      "\xFF\xE1\0\x22"
      "Exif\0\0II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0\1\0\0\0\0\0\0\0",
      36);
  exif[28] = turn;
  std::string whole(bytes.begin(), bytes.end());
  return whole.insert(2, exif);
}

TEST(LoadPicture, LeavesAloneTheTurnThatExifAsksFor) {
  const TemporaryFolder folder;
  for (const char turn : {'\3', '\6'}) {
    const auto file = folder.write("turned.jpg", turned_jpeg(turn));
    EXPECT_EQ(cv::imread(file.string()).cols, turn == '\6' ? 20 : 40) << "the file does ask for a turn";
    const cv::Mat picture = load_picture(file);
    ASSERT_EQ(picture.cols, 40);
    EXPECT_LT(picture.at<cv::Vec3b>(10, 5)[0], 100);
    const auto painted = read_picture(file);
    ASSERT_TRUE(painted) << painted.error().message;
    EXPECT_EQ(painted->width_px, picture.cols);
    EXPECT_LT(painted->rgba[(10 * 40 + 5) * 4], 100) << "what is painted lies as what was calibrated";
  }
}

TEST(LoadPicture, WhatIsNoPictureIsEmpty) {
  const TemporaryFolder folder;
  EXPECT_TRUE(load_picture(folder.write("a.png", "no picture")).empty());
  EXPECT_TRUE(load_picture(folder.write("b.png", "")).empty());
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(load_picture(folder / "gone.png").empty());
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "whoever asked says it";
  // A PNG header that asks for more pixels than OpenCV takes.
  EXPECT_TRUE(
      load_picture(
          folder.write(
              "c.png",
              std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\1\0\0\0\1\0\0\x08\2\0\0\0\x1c\xc4\x3f\x0c", 33)))
          .empty());
}

}  // namespace
}  // namespace orcart
