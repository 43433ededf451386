// Rectified pictures are written beside those that were read, never over them or over each other.
#include "tools/calibration/rectify.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

ScopeModel small_scope() {
  ScopeModel scope{.name = "small", .width_px = 64, .height_px = 48};
  scope.lens = {.fx_px = 60, .fy_px = 60, .cx_px = 32, .cy_px = 24, .max_angle_rad = 1};
  return scope;
}

void write_picture(const std::filesystem::path& file) {
  std::filesystem::create_directories(file.parent_path());
  cv::imwrite(file.string(), cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(77)));
}

TEST(Rectify, WritesAPictureForEach) {
  const TemporaryFolder folder;
  write_picture(folder / "a.png");
  write_picture(folder / "b.jpg");
  const auto done = rectify({folder / "a.png", folder / "b.jpg"}, small_scope(), folder / "straight");
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_TRUE(std::filesystem::exists(folder / "straight/a.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "straight/b.png"));
}

TEST(Rectify, RefusesToWriteOverThePicturesItReads) {
  const TemporaryFolder folder;
  write_picture(folder / "a.png");
  const auto size = std::filesystem::file_size(folder / "a.png");
  const auto done = rectify({folder / "a.png"}, small_scope(), folder / "other/..");
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("a.png: would be written over"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(folder / "a.png"), size);
}

TEST(Rectify, RefusesTwoPicturesOfOneName) {
  const TemporaryFolder folder;
  write_picture(folder / "one/a.png");
  write_picture(folder / "two/a.jpg");
  const auto done = rectify({folder / "one/a.png", folder / "two/a.jpg"}, small_scope(), folder / "straight");
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("would both become"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "straight"));
}

}  // namespace
}  // namespace orcart
