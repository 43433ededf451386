// From a driver's buffer to a frame: instants by every meaning of a stamp, and the camera's health.
#include "firmware-host/camera/frame_intake.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

constexpr Instant at_ms(double ms) {
  return instant_from_nanos(1'000'000'000) + from_seconds(ms * 1e-3);
}

FrameBuffer buffer_at(double stamp_ms, std::uint32_t sequence = 0) {
  return {.index = 3, .image = {}, .sequence = sequence, .stamp = at_ms(stamp_ms), .exposure = {}};
}

CapturedFrame accepted(const StampSettings& settings, const FrameBuffer& buffer) {
  FrameIntake intake(settings);
  return intake.accept(buffer, at_ms(130));
}

TEST(FrameIntake, ReadsTheStampAsItsConfiguredMeaning) {
  const FrameBuffer buffer = buffer_at(100);
  using M = StampMeaning;
  const auto mid = [&](M meaning) {
    return accepted({.meaning = meaning, .exposure = 8ms, .after_exposure = 16ms}, buffer).mid_exposure();
  };
  EXPECT_EQ(mid(M::start_of_exposure), at_ms(104));
  EXPECT_EQ(mid(M::end_of_exposure), at_ms(96));
  EXPECT_EQ(mid(M::start_of_readout), at_ms(80));
  EXPECT_EQ(mid(M::end_of_readout), at_ms(80));
  EXPECT_EQ(mid(M::dequeued), at_ms(110));
}

TEST(FrameIntake, BelievesTheDriversExposureBeforeTheConfiguredOne) {
  FrameBuffer buffer = buffer_at(100);
  buffer.exposure = 2ms;
  const CapturedFrame frame = accepted({.meaning = StampMeaning::end_of_exposure, .exposure = 8ms}, buffer);
  EXPECT_EQ(frame.exposure_start, at_ms(98));
  EXPECT_EQ(frame.exposure_end, at_ms(100));
}

TEST(FrameIntake, KeepsTheLoan) {
  const CapturedFrame frame = accepted({}, buffer_at(100, 42));
  EXPECT_EQ(frame.buffer, 3U);
  EXPECT_EQ(frame.sequence, 42U);
  EXPECT_EQ(frame.dequeued_at, at_ms(130));
}

TEST(FrameIntake, KnowsEveryMeaningByItsNameAndNoOther) {
  for (const NamedStampMeaning& known : kStampMeanings)
    EXPECT_EQ(stamp_meaning_of(known.name), known.meaning);
  EXPECT_FALSE(stamp_meaning_of("end_of_frame"));
  EXPECT_FALSE(stamp_meaning_of(""));
}

TEST(FrameIntake, CountsLostFramesAndRestartsAcrossTheWrap) {
  FrameIntake intake({});
  std::vector<std::uint32_t> sequences{0xFFFFFFFEU, 0xFFFFFFFFU, 0, 1, 4, 5, 0, 1};
  for (std::size_t i = 0; i < sequences.size(); ++i)
    (void)intake.accept(buffer_at(33.0 * static_cast<double>(i), sequences[i]),
                        at_ms(40 + 33.0 * static_cast<double>(i)));
  EXPECT_EQ(intake.health().frames, 8U);
  EXPECT_EQ(intake.health().lost, 2U);
  EXPECT_EQ(intake.health().restarts, 1U);
}

TEST(FrameIntake, CallsThreeImpossibleStampsInARowAFault) {
  FrameIntake intake({});
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(intake.health().stamps_faulty);
    (void)intake.accept(buffer_at(200, i), at_ms(100 + i));
  }
  EXPECT_TRUE(intake.health().stamps_faulty);
}

TEST(FrameIntake, NoticesAPictureThatStandsStillForASecond) {
  std::vector<std::byte> pixels(64 * 48, std::byte{90});
  FrameIntake intake({});
  for (std::uint32_t i = 0; i <= 31; ++i) {
    FrameBuffer buffer = buffer_at(33.0 * i, i);
    buffer.image = packed_image(pixels.data(), PixelFormat::gray8, 64, 48);
    (void)intake.accept(buffer, at_ms(33.0 * i + 10));
    EXPECT_EQ(intake.health().frozen, i == 31) << i;
  }
  EXPECT_EQ(intake.health().repeats, 31U);
}

TEST(FrameIntake, AllocatesNothing) {
  std::vector<std::byte> pixels(packed_bytes(PixelFormat::yuyv, 640, 480), std::byte{90});
  FrameIntake intake({});
  FrameBuffer buffer = buffer_at(100);
  buffer.image = packed_image(pixels.data(), PixelFormat::yuyv, 640, 480);
  EXPECT_TRUE(testing::zero_allocation([&] { (void)intake.accept(buffer, at_ms(110)); }));
}

}  // namespace
}  // namespace orcart
