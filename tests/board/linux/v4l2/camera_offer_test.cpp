// What is wanted against what is offered: accepted, or refused with what could be had.
#include "board/linux/v4l2/camera_offer.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

CameraMode mode(WireFormat format, int width, int height, std::vector<RateRange> rates) {
  return {static_cast<std::uint32_t>(format), {width, width, 1}, {height, height, 1}, std::move(rates)};
}

const CameraOffer kGrabber{.card = "USB Video",
                           .modes = {mode(WireFormat::mjpeg, 1920, 1080, {{30, 30}, {60, 60}}),
                                     mode(WireFormat::yuyv, 640, 480, {{30, 30}, {25, 25}}),
                                     mode(WireFormat::yuyv, 1920, 1080, {{5, 5}})}};

std::string refusal(const CameraWish& wish, const CameraOffer& offer = kGrabber) {
  const auto fits = check(wish, offer);
  return fits ? "" : fits.error().message;
}

TEST(CameraOffer, AcceptsAModeThatIsThere) {
  EXPECT_EQ(refusal({.format = WireFormat::mjpeg, .width_px = 1920, .height_px = 1080, .rate_hz = 60}), "");
  EXPECT_EQ(refusal({.rate_hz = 25}), "");
}

TEST(CameraOffer, ListsFormatsThenSizesThenRates) {
  EXPECT_EQ(refusal({.format = WireFormat::nv12}),
            "camera /dev/video0 (USB Video) does not deliver nv12; it offers mjpeg, yuyv");
  EXPECT_EQ(refusal({.width_px = 800, .height_px = 600}),
            "camera /dev/video0 (USB Video) does not deliver yuyv in 800x600; it offers 1920x1080, 640x480");
  EXPECT_EQ(refusal({.rate_hz = 60}),
            "camera /dev/video0 (USB Video) does not deliver yuyv in 640x480 at 60 Hz; it offers 30, 25 Hz");
}

TEST(CameraOffer, TellsRatesApartThatDifferByOnePerMill) {
  const CameraOffer ntsc{.modes = {mode(WireFormat::yuyv, 640, 480, {{30000.0 / 1001, 30000.0 / 1001}})}};
  EXPECT_NE(refusal({.rate_hz = 30}, ntsc), "");
  EXPECT_EQ(refusal({.rate_hz = 29.97}, ntsc), "");
}

TEST(CameraOffer, ReadsRangesOfSizesAndRates) {
  CameraMode range{static_cast<std::uint32_t>(WireFormat::yuyv), {32, 1920, 2}, {32, 1080, 2}, {{1, 60}}};
  const CameraOffer scaler{.modes = {range}};
  EXPECT_EQ(refusal({.rate_hz = 42.5}, scaler), "");
  EXPECT_NE(refusal({.width_px = 641}, scaler), "") << "not a step of two";
  EXPECT_NE(refusal({.rate_hz = 61}, scaler), "");
  EXPECT_EQ(text_of(range), "32x32 to 1920x1080 at 1 to 60 Hz");
}

TEST(CameraOffer, LooksForTheWholePictureWhereAFieldIsWanted) {
  EXPECT_EQ(refusal({.height_px = 240, .rate_hz = 25, .field = FieldChoice::top}), "");
  EXPECT_NE(refusal({.height_px = 480, .rate_hz = 25, .field = FieldChoice::top}), "");
}

TEST(CameraOffer, DoesNotJudgeADeviceThatListsNothing) {
  EXPECT_EQ(refusal({}, {}), "");
  const CameraOffer television{.modes = {mode(WireFormat::yuyv, 0, 0, {})}};
  EXPECT_EQ(refusal({.width_px = 720, .height_px = 288}, television), "");
}

TEST(CameraOffer, SpellsCodesThatCannotBePrinted) {
  EXPECT_EQ(name_of_code(fourcc('H', '2', '6', '4')), "H264");
  EXPECT_EQ(name_of_code(0x01000041), "A???");
}

}  // namespace
}  // namespace orcart
