// Captures on their way from the render thread to the session thread.
#include "firmware-host/session/capture_slots.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/firmware-host/session/session_samples.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using testing::facts_number;
using testing::frame_number;

constexpr std::size_t kBytes = packed_bytes(PixelFormat::yuyv, testing::kWidth_px, testing::kHeight_px);

TEST(CaptureSlots, CopyThePictureSoThatTheCamerasBufferMayGoHome) {
  CaptureSlots slots(2, kBytes);
  auto bytes = testing::picture_bytes(5);
  const auto original = bytes;
  ASSERT_TRUE(slots.offer(frame_number(5, bytes), facts_number(5)));
  std::ranges::fill(bytes, std::byte{0});
  const auto note = slots.next();
  ASSERT_TRUE(note);
  const CaptureSlot& slot = slots[note->slot];
  EXPECT_TRUE(std::ranges::equal(slot.picture(), original));
  EXPECT_EQ(slot.frame.sequence, 1005U);
  EXPECT_EQ(slot.facts.unit, 5U);
}

TEST(CaptureSlots, LeaveOutThePaddingOfRows) {
  std::vector<std::byte> padded(40 * 3, std::byte{1});
  ImageDescriptor image = packed_image(padded.data(), PixelFormat::nv12, 16, 2);
  image.planes[0] = {.data = padded.data(), .stride_bytes = 40};
  image.planes[1] = {.data = padded.data(), .offset_bytes = 80, .stride_bytes = 40};
  for (std::size_t row = 0; row < 3; ++row)
    std::fill_n(padded.begin() + static_cast<std::ptrdiff_t>(40 * row), 16, static_cast<std::byte>(10 + row));
  CaptureSlots slots(1, 48);
  ASSERT_TRUE(slots.offer({.image = image}, {}));
  const CaptureSlot& slot = slots[slots.next()->slot];
  ASSERT_EQ(slot.used_bytes, 48U);
  for (std::size_t i = 0; i < 48; ++i) EXPECT_EQ(slot.pixels[i], static_cast<std::byte>(10 + i / 16)) << i;
}

TEST(CaptureSlots, RefuseAndCountWhatTheyCannotKeep) {
  CaptureSlots slots(1, kBytes);
  auto bytes = testing::picture_bytes(1);
  EXPECT_FALSE(slots.offer({}, {}));  // no picture
  CapturedFrame elsewhere = frame_number(1, bytes);
  elsewhere.image.planes[0] = {.dma_buf_fd = 3};
  EXPECT_FALSE(slots.offer(elsewhere, {}));
  CapturedFrame large = frame_number(1, bytes);
  large.image.height_px += 2;
  EXPECT_FALSE(slots.offer(large, {}));
  EXPECT_TRUE(slots.offer(frame_number(1, bytes), {}));
  EXPECT_FALSE(slots.offer(frame_number(2, bytes), {}));  // no free slot
  EXPECT_EQ(slots.lost(), 4U);
  slots.give_back(slots.next()->slot);
  EXPECT_TRUE(slots.offer(frame_number(3, bytes), {}));
}

TEST(CaptureSlots, TellOfUndoneUnitsInTheirPlace) {
  CaptureSlots slots(4, kBytes);
  auto bytes = testing::picture_bytes(1);
  ASSERT_TRUE(slots.offer(frame_number(1, bytes), facts_number(1)));
  ASSERT_TRUE(slots.undone(1));
  ASSERT_TRUE(slots.offer(frame_number(2, bytes), facts_number(2)));
  EXPECT_EQ(slots.next()->kind, SessionNote::Kind::captured);
  const auto second = slots.next();
  EXPECT_EQ(second->kind, SessionNote::Kind::undone);
  EXPECT_EQ(second->unit, 1U);
  EXPECT_EQ(slots.next()->kind, SessionNote::Kind::captured);
  EXPECT_FALSE(slots.next());
}

TEST(CaptureSlots, AllocateNothing) {
  CaptureSlots slots(2, kBytes);
  auto bytes = testing::picture_bytes(1);
  const CapturedFrame frame = frame_number(1, bytes);
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (int i = 0; i < 10; ++i) {
      (void)slots.offer(frame, {});
      (void)slots.undone(1);
    }
  }));
}

}  // namespace
}  // namespace orcart
