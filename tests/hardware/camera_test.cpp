// The V4L2 camera on a real driver: the seam's contract, a hundred frames, and the faults that vivid can
// play.
#include <cstdio>
#include <iostream>

#include "board/linux/v4l2/v4l2_frame_source.hpp"
#include "tests/board/ports/frame_source_contract.hpp"
#include "tests/hardware/environment.hpp"

namespace orcart::testing {
namespace {

/// What the two variables name; a mode that cannot be read leaves the default.
CameraWish wish_from_environment() {
  CameraWish wish{.device = device_named("ORCART_TEST_CAMERA").value_or(""), .rate_hz = 25};
  const std::string mode = device_named("ORCART_TEST_CAMERA_MODE").value_or("yuyv:640x480@25");
  char format[8] = "", field[8] = "";
  (void)std::sscanf(mode.c_str(), "%7[a-z0-9]:%dx%d@%lf:%7s", format, &wish.width_px, &wish.height_px,
                    &wish.rate_hz, field);
  for (const WireFormat known : {WireFormat::yuyv, WireFormat::uyvy, WireFormat::nv12, WireFormat::mjpeg})
    if (name_of(known) == format) wish.format = known;
  if (std::string(field) == "top") wish.field = FieldChoice::top;
  if (std::string(field) == "bottom") wish.field = FieldChoice::bottom;
  return wish;
}

class V4l2Rig : public FrameSourceRig {
 public:
  V4l2Rig() {
    if (wish.device.empty()) return;
    auto opened = V4l2FrameSource::open({.wish = wish, .clock = clock_});
    if (opened) source_ = std::move(*opened);
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  }
  std::string missing() const override {
    if (wish.device.empty()) return not_set("ORCART_TEST_CAMERA");
    return source_ ? "" : "the camera does not open";
  }
  Clock& clock() override { return clock_; }
  FrameSource& source() override { return *source_; }
  Nanos tolerance() const override { return 60ms; }  // a virtual machine's
  bool may_lose_frames() const override { return true; }

  CameraWish wish = wish_from_environment();

 protected:
  RealClock clock_;
  std::unique_ptr<V4l2FrameSource> source_;
};

class Camera : public ::testing::Test {
 protected:
  void SetUp() override {
    if (wish.device.empty()) GTEST_SKIP() << not_set("ORCART_TEST_CAMERA");
    auto opened = V4l2FrameSource::open({.wish = wish, .clock = clock});
    ASSERT_TRUE(opened) << opened.error().message;
    source = std::move(*opened);
    ASSERT_TRUE(source->start());
    ASSERT_TRUE(good_frame(5s));
  }
  /// The next good frame, given back at once; the first fault on the way stops it.
  Result<FrameBuffer, PortFault> next(Nanos patience) {
    const Instant end = clock.now() + patience;
    while (clock.now() < end) {
      source->wait(std::min(end, clock.now() + 5ms));
      auto frame = source->take();
      if (frame) source->give_back(frame->index);
      if (frame || frame.error() != PortFault::nothing_yet) return frame;
    }
    return tl::unexpected(PortFault::nothing_yet);
  }
  bool good_frame(Nanos patience) {
    const Instant end = clock.now() + patience;
    while (clock.now() < end)
      if (next(patience)) return true;
    return false;
  }
  /// The first fault other than `damaged`.
  PortFault fault_within(Nanos patience) {
    const Instant end = clock.now() + patience;
    while (clock.now() < end)
      if (auto frame = next(100ms);
          !frame && frame.error() != PortFault::nothing_yet && frame.error() != PortFault::damaged)
        return frame.error();
    return PortFault::nothing_yet;
  }
  void press(const std::string& button) {
    auto node = open_camera_node(system_calls(), wish.device);
    ASSERT_TRUE(node);
    const auto pressed = set_controls(*node, {.device = wish.device, .controls = {{button, 0}}});
    ASSERT_TRUE(pressed) << pressed.error().sentence;
  }
  bool is_vivid() {
    auto node = open_camera_node(system_calls(), wish.device);
    return node && driver_of(*node) == "vivid";
  }

  CameraWish wish = wish_from_environment();
  RealClock clock;
  std::unique_ptr<V4l2FrameSource> source;
};

TEST_F(Camera, DeliversAHundredFramesInOrderAndSaysWhatOneCosts) {
  std::uint32_t last = 0, gaps = 0;
  const Nanos began = thread_time();
  for (int i = 0; i < 100; ++i) {
    const auto frame = next(2s);
    ASSERT_TRUE(frame) << word_for(frame.error());
    if (i > 0) {
      EXPECT_GT(frame->sequence, last);
      gaps += frame->sequence - last - 1;
    }
    last = frame->sequence;
  }
  const Nanos cost = (thread_time() - began) / 100;
  std::cout << "camera " << source->card() << ": " << gaps << " frames lost of 100, " << microseconds(cost)
            << " us of processor time a frame, dma-bufs "
            << (source->exports_dma_bufs() ? "exported" : "not exported") << ", stamps "
            << (source->stamps_are_monotonic() ? "monotonic" : "of no known clock") << "\n";
}

TEST_F(Camera, ClosesEverythingItOpened) {
  source.reset();
  const auto before = open_descriptors();
  for (int i = 0; i < 3; ++i) {
    auto again = V4l2FrameSource::open({.wish = wish, .clock = clock});
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_TRUE((*again)->start());
    ASSERT_TRUE((*again)->recover());
  }
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(Camera, IsBusyWhileAnotherProgramStreams) {
  const auto second = V4l2FrameSource::open({.wish = wish, .clock = clock});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("end that one"), std::string::npos) << second.error().message;
}

TEST_F(Camera, SkipsAnErrorBufferAndGoesOn) {
  if (!is_vivid()) GTEST_SKIP() << "only vivid can be told to fail";
  press("inject_v4l2_buf_flag_error");
  bool damaged = false;
  for (int i = 0; i < 20 && !damaged; ++i) {
    const auto frame = next(1s);
    damaged = !frame && frame.error() == PortFault::damaged;
  }
  EXPECT_TRUE(damaged);
  EXPECT_TRUE(good_frame(1s));
}

TEST_F(Camera, StreamsAgainAfterAFatalError) {
  if (!is_vivid()) GTEST_SKIP() << "only vivid can be told to fail";
  press("inject_fatal_streaming_error");
  EXPECT_EQ(fault_within(1s), PortFault::io);
  const Instant broken = clock.now();
  ASSERT_TRUE(source->recover()) << source->trouble();
  EXPECT_TRUE(good_frame(2s));
  EXPECT_LE(clock.now() - broken, 3s);  // within 1 s on a cart; a busy machine's guest takes longer
}

// The panel's inset always holds one.
TEST_F(Camera, StreamsAgainAfterAFatalErrorWhileAPictureIsLent) {
  if (!is_vivid()) GTEST_SKIP() << "only vivid can be told to fail";
  Result<FrameBuffer, PortFault> lent = tl::unexpected(PortFault::nothing_yet);
  for (const Instant end = clock.now() + 2s; !lent && clock.now() < end; lent = source->take())
    source->wait(clock.now() + 5ms);
  ASSERT_TRUE(lent);
  press("inject_fatal_streaming_error");
  EXPECT_EQ(fault_within(1s), PortFault::io);
  ASSERT_TRUE(source->recover()) << source->trouble();
  EXPECT_TRUE(good_frame(2s));
  source->give_back(lent->index);
  EXPECT_TRUE(good_frame(2s));
}

TEST_F(Camera, SaysThatTheStreamDoesNotStartAndStartsItLater) {
  if (!is_vivid()) GTEST_SKIP() << "only vivid can be told to fail";
  press("inject_vidioc_streamon_error");
  EXPECT_FALSE(source->recover());
  EXPECT_TRUE(source->recover()) << source->trouble();
  EXPECT_TRUE(good_frame(2s));
}

TEST_F(Camera, NoticesThatItIsPulledOutAndComesBack) {
  if (!is_vivid()) GTEST_SKIP() << "only vivid can be told to fail";
  source->wait(clock.now() + 1s);
  press("disconnect");
  EXPECT_EQ(fault_within(1s), PortFault::disconnected);
  bool back = false;
  for (int i = 0; i < 20 && !back; ++i) {
    back = source->recover().has_value();
    if (!back) clock.sleep_until(clock.now() + 100ms);
  }
  EXPECT_TRUE(back) << source->trouble();
  EXPECT_TRUE(good_frame(2s));
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Linux, FrameSourceContract, V4l2Rig);

}  // namespace orcart::testing
