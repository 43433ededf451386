// The real camera's policy against a played driver: lending, damage, fields, every fault, and that nothing
// leaks.
#include "board/linux/v4l2/v4l2_frame_source.hpp"

#include <gtest/gtest.h>

#include "tests/board/linux/v4l2/scripted_camera_device.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

class V4l2FrameSourceTest : public ::testing::Test {
 protected:
  void open(const CameraWish& changes = {.width_px = 64, .height_px = 48}) {
    wish = changes;
    wish.device = "/dev/video7";
    auto opened = V4l2FrameSource::open({.wish = wish, .buffers = 4, .clock = clock, .calls = device});
    ASSERT_TRUE(opened) << opened.error().message;
    source = std::move(*opened);
    ASSERT_TRUE(source->start());
  }
  std::string refusal(const CameraWish& changes) {
    wish = changes;
    wish.device = "/dev/video7";
    auto opened = V4l2FrameSource::open({.wish = wish, .buffers = 4, .clock = clock, .calls = device});
    return opened ? "" : opened.error().message;
  }
  PortFault fault() {
    const auto frame = source->take();
    return frame ? PortFault::nothing_yet : frame.error();
  }

  SimulatedClock clock;
  ScriptedCameraDevice device{clock};
  CameraWish wish;
  std::unique_ptr<V4l2FrameSource> source;
};

const CameraWish kSmall{.width_px = 64, .height_px = 48};

TEST_F(V4l2FrameSourceTest, LendsABufferWithItsSequenceStampAndDmaBuf) {
  open();
  device.sequence = 41;
  clock.advance_by(5ms);
  ASSERT_TRUE(device.fill());
  const auto frame = source->take();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->sequence, 41u);
  EXPECT_EQ(frame->stamp, clock.now());
  EXPECT_EQ(frame->image.width_px, 64);
  EXPECT_EQ(frame->image.planes[0].stride_bytes, 128u);
  EXPECT_GE(frame->image.planes[0].dma_buf_fd, 1000);
  EXPECT_EQ(frame->image.planes[0].data, device.memory(frame->index));
  EXPECT_TRUE(source->exports_dma_bufs());
}

TEST_F(V4l2FrameSourceTest, DoesWithoutDmaBufsWhereTheDriverExportsNone) {
  device.exports = false;
  open();
  ASSERT_TRUE(device.fill());
  EXPECT_EQ(source->take()->image.planes[0].dma_buf_fd, -1);
  EXPECT_FALSE(source->exports_dma_bufs());
}

TEST_F(V4l2FrameSourceTest, QueuesABufferAgainOnlyWhenItIsGivenBack) {
  open();
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(device.fill());
  EXPECT_FALSE(device.fill()) << "all buffers are filled";
  const auto frame = source->take();
  EXPECT_TRUE(device.queued.empty());
  source->give_back(frame->index);
  source->give_back(frame->index);
  EXPECT_EQ(device.queued, (std::deque<std::uint32_t>{frame->index}));
}

TEST_F(V4l2FrameSourceTest, CallsErrorBuffersAndShortOnesDamagedAndQueuesThemAgain) {
  open();
  ASSERT_TRUE(device.fill(device.image_bytes, V4L2_BUF_FLAG_ERROR));
  ASSERT_TRUE(device.fill(100));
  ASSERT_TRUE(device.fill());
  EXPECT_EQ(fault(), PortFault::damaged);
  EXPECT_EQ(fault(), PortFault::damaged);
  EXPECT_EQ(device.queued.size(), 3u);
  EXPECT_TRUE(source->take());
}

TEST_F(V4l2FrameSourceTest, SaysIoAndStreamsAgainAfterRecovery) {
  open();
  device.dequeue_error = -EIO;
  EXPECT_EQ(fault(), PortFault::io);
  device.dequeue_error = 0;
  EXPECT_EQ(fault(), PortFault::io) << "a fault stays until it is mended";
  ASSERT_TRUE(source->recover());
  ASSERT_TRUE(device.fill());
  EXPECT_TRUE(source->take());
  EXPECT_EQ(device.opened - device.closed, 1);
}

TEST_F(V4l2FrameSourceTest, TakesAPollErrorForAFailureInsteadOfSpinning) {
  open();
  device.poll_error = true;
  source->wait(clock.now() + 5ms);
  EXPECT_EQ(fault(), PortFault::io);
  const Instant deadline = clock.now() + 5ms;
  source->wait(deadline);
  EXPECT_EQ(clock.now(), deadline) << "with a fault, waiting is sleeping";
}

TEST_F(V4l2FrameSourceTest, SleepsWhileEveryBufferIsLent) {
  open();
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(device.fill() && source->take());
  device.poll_error = true;  // what vb2 answers without a queued buffer
  const Instant deadline = clock.now() + 5s;
  source->wait(deadline);
  EXPECT_EQ(clock.now(), deadline);
  EXPECT_EQ(fault(), PortFault::nothing_yet);
}

TEST_F(V4l2FrameSourceTest, KeepsLentPicturesReadableWhileTheDeviceIsPulledOutAndPutBack) {
  open();
  ASSERT_TRUE(device.fill());
  const auto lent = source->take();
  ASSERT_TRUE(lent);
  lent->image.planes[0].data[0] = std::byte{77};
  device.dequeue_error = -ENODEV;
  EXPECT_EQ(fault(), PortFault::disconnected);
  device.open_error = -ENOENT;
  EXPECT_EQ(source->recover().error(), PortFault::disconnected);
  EXPECT_NE(source->trouble().find("/dev/video7"), std::string::npos);
  EXPECT_EQ(fault(), PortFault::disconnected);
  device.open_error = device.dequeue_error = 0;
  ASSERT_TRUE(source->recover());
  EXPECT_TRUE(device.mapped.contains(lent->image.planes[0].data)) << "still on loan";
  EXPECT_EQ(lent->image.planes[0].data[0], std::byte{77});
  EXPECT_EQ(device.queued.size(), 3u);
  source->give_back(lent->index);
  EXPECT_EQ(device.queued.size(), 4u) << "and its place is filled by the new device's buffer";
  EXPECT_FALSE(device.mapped.contains(lent->image.planes[0].data));
}

TEST_F(V4l2FrameSourceTest, StreamsAgainWhileAPictureIsStillLent) {
  open();
  ASSERT_TRUE(device.fill());
  const auto lent = source->take();
  ASSERT_TRUE(lent);
  device.dequeue_error = -EIO;
  EXPECT_EQ(fault(), PortFault::io);
  device.dequeue_error = 0;
  ASSERT_TRUE(source->recover()) << source->trouble();
  ASSERT_TRUE(device.fill());
  EXPECT_TRUE(source->take());
  EXPECT_TRUE(device.mapped.contains(lent->image.planes[0].data)) << "readable until it comes home";
}

TEST_F(V4l2FrameSourceTest, LendsNoBufferTwiceThoughItsDriverHandsItOutAgain) {
  open();
  ASSERT_TRUE(device.fill());
  const auto lent = source->take();
  ASSERT_TRUE(lent);
  device.dequeue_error = -EIO;
  EXPECT_EQ(fault(), PortFault::io);
  device.dequeue_error = 0;
  ASSERT_TRUE(source->recover());
  device.fill_unqueued(lent->index);
  EXPECT_EQ(fault(), PortFault::damaged) << "its memory would be unmapped when the first loan comes home";
  EXPECT_TRUE(device.mapped.contains(lent->image.planes[0].data));
  EXPECT_EQ(device.queued.size(), 3u) << "nor is it queued while it is lent";
  source->give_back(lent->index);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(device.fill());
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(source->take());
}

TEST_F(V4l2FrameSourceTest, LeaksNothingOverManyFaultsAndItsEnd) {
  open();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(device.fill());
    (void)source->take();
    device.dequeue_error = -ENODEV;
    EXPECT_EQ(fault(), PortFault::disconnected);
    device.open_error = i % 3 == 0 ? -EACCES : 0;
    device.dequeue_error = 0;
    (void)source->recover();
    device.open_error = 0;
    ASSERT_TRUE(source->recover());
    for (std::uint32_t b = 0; b < 4; ++b) source->give_back(b);
  }
  EXPECT_EQ(device.mapped.size(), 4u);
  EXPECT_EQ(device.dma_bufs.size(), 4u);
  source.reset();
  EXPECT_EQ(device.opened, device.closed);
  EXPECT_TRUE(device.mapped.empty());
  EXPECT_TRUE(device.dma_bufs.empty());
}

TEST_F(V4l2FrameSourceTest, NoticesADriverThatStops) {
  open();
  EXPECT_EQ(fault(), PortFault::nothing_yet);
  clock.advance_by(2900ms);
  EXPECT_EQ(fault(), PortFault::nothing_yet) << "the first frame may take its time";
  ASSERT_TRUE(device.fill());
  source->give_back(source->take()->index);
  clock.advance_by(499ms);
  EXPECT_EQ(fault(), PortFault::nothing_yet);
  clock.advance_by(2ms);
  EXPECT_EQ(fault(), PortFault::timed_out);
}

TEST_F(V4l2FrameSourceTest, StopsForAChangeOfTheSignalAndRefusesAnotherSize) {
  open();
  device.source_change = true;
  source->wait(clock.now() + 5ms);
  EXPECT_EQ(fault(), PortFault::io);
  device.height = 40;
  EXPECT_EQ(source->recover().error(), PortFault::unsupported);
  EXPECT_NE(source->trouble().find("64x40"), std::string::npos) << source->trouble();
  device.height = 48;
  EXPECT_TRUE(source->recover());
}

TEST_F(V4l2FrameSourceTest, ReportsAStreamThatDoesNotStart) {
  open();
  device.dequeue_error = -EIO;
  (void)fault();
  device.dequeue_error = 0;
  device.stream_on_error = -EINVAL;
  EXPECT_EQ(source->recover().error(), PortFault::io);
  device.stream_on_error = 0;
  EXPECT_TRUE(source->recover());
}

TEST_F(V4l2FrameSourceTest, TakesOneFieldOfAWovenPictureWithItsOwnStamp) {
  device.field = V4L2_FIELD_INTERLACED_TB;
  open({.width_px = 64, .height_px = 24, .rate_hz = 30, .field = FieldChoice::top});
  clock.advance_by(100ms);
  ASSERT_TRUE(device.fill(device.image_bytes, 0, V4L2_FIELD_INTERLACED_TB));
  const auto frame = source->take();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->image.height_px, 24);
  EXPECT_EQ(frame->image.planes[0].stride_bytes, 256u);
  EXPECT_EQ(frame->image.planes[0].offset_bytes, 0u);
  EXPECT_EQ(frame->stamp, clock.now() - period_of(30) / 2) << "the top field is the older one";
}

TEST_F(V4l2FrameSourceTest, DropsTheOtherFieldWhereTheyComeOneAtATime) {
  device.field = V4L2_FIELD_ALTERNATE;
  open({.width_px = 64, .height_px = 24, .field = FieldChoice::bottom});
  ASSERT_TRUE(device.fill(device.image_bytes, 0, V4L2_FIELD_TOP));
  device.sequence = 0;  // both fields of a frame have one number
  ASSERT_TRUE(device.fill(device.image_bytes, 0, V4L2_FIELD_BOTTOM));
  const auto frame = source->take();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->sequence, 0u);
  EXPECT_EQ(fault(), PortFault::nothing_yet);
  EXPECT_EQ(device.queued.size(), 3u);
}

TEST_F(V4l2FrameSourceTest, RefusesInOneSentenceWithTheRemedy) {
  device.open_error = -ENOENT;
  EXPECT_NE(refusal(kSmall).find("plug the camera in"), std::string::npos);
  device.open_error = -EACCES;
  EXPECT_NE(refusal(kSmall).find("group video"), std::string::npos);
  device.open_error = -EBUSY;
  EXPECT_NE(refusal(kSmall).find("end the program"), std::string::npos);
  device.open_error = 0;
  EXPECT_NE(refusal({.format = WireFormat::nv12}).find("it offers yuyv"), std::string::npos);
  EXPECT_NE(refusal({.width_px = 640, .height_px = 480}).find("it offers 64x48"), std::string::npos);
  EXPECT_NE(refusal({.width_px = 64, .height_px = 48, .rate_hz = 60}).find("it offers 30 Hz"),
            std::string::npos);
  EXPECT_NE(refusal({.width_px = 64, .height_px = 24, .field = FieldChoice::top}).find("whole pictures"),
            std::string::npos);
  device.capabilities = V4L2_CAP_VIDEO_OUTPUT;
  EXPECT_NE(refusal(kSmall).find("does not deliver pictures"), std::string::npos);
  device.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  EXPECT_NE(refusal(kSmall).find("in several planes only"), std::string::npos);
  EXPECT_EQ(device.opened, device.closed) << "a refusal leaves nothing open";
  EXPECT_TRUE(device.mapped.empty());
}

TEST_F(V4l2FrameSourceTest, SetsControlsByNameAndSaysWhatTheyTake) {
  open({.width_px = 64, .height_px = 48, .controls = {{"exposure_time_absolute", 80}}});
  EXPECT_EQ(device.controls[V4L2_CID_EXPOSURE_ABSOLUTE], 80);
  source.reset();
  EXPECT_NE(refusal({.width_px = 64, .height_px = 48, .controls = {{"exposure_time_absolute", 9000}}})
                .find("1 to 5000"),
            std::string::npos);
  EXPECT_NE(refusal({.width_px = 64, .height_px = 48, .controls = {{"zoom", 1}}})
                .find("it has exposure_time_absolute"),
            std::string::npos);
}

TEST_F(V4l2FrameSourceTest, TellsWhenTheDriversStampsBelongToNoClock) {
  open();
  EXPECT_TRUE(source->stamps_are_monotonic());
  device.stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_COPY;
  ASSERT_TRUE(source->recover());
  EXPECT_FALSE(source->stamps_are_monotonic());
}

TEST_F(V4l2FrameSourceTest, AllocatesNothingWhileItStreams) {
  open();
  std::array<std::uint32_t, 4> held{};
  ASSERT_TRUE(device.fill());
  EXPECT_TRUE(zero_allocation([&] {
    source->wait(clock.now() + 1ms);
    const auto frame = source->take();
    if (frame) held[0] = frame->index;
    source->give_back(held[0]);
  }));
}

}  // namespace
}  // namespace orcart::testing
