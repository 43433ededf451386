// The simulated camera: the seam's contract, its exact instants, and each of its faults.
#include "board/sim/simulated_frame_source.hpp"

#include "tests/board/ports/frame_source_contract.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

const Instant kStart = SimulatedClock().now();
constexpr ExposureTiming kTiming{.rate_hz = 50, .exposure = 8ms, .first = 2ms};

/// 100 frames of 4 x 2 grey pixels; frame k's bytes all hold k.
MemoryPictures counted_pictures() {
  std::vector<std::vector<std::byte>> pictures;
  for (int k = 0; k < 100; ++k) pictures.emplace_back(8, static_cast<std::byte>(k));
  return {
      {.width_px = 4, .height_px = 2, .format = PixelFormat::gray8, .rate_hz = 50}, kTiming, 100, pictures};
}

class SimulatedFrameSourceRig final : public testing::FrameSourceRig {
 public:
  Clock& clock() override { return clock_; }
  FrameSource& source() override { return source_; }

 private:
  SimulatedClock clock_;
  MemoryPictures pictures_ = counted_pictures();
  SimulatedFrameSource source_{clock_, pictures_, {.start = kStart, .buffers = 4}};
};

/// A started camera with some faults, and what a camera thread would do with it.
struct Bench {
  SimulatedClock clock;
  MemoryPictures pictures = counted_pictures();
  SimulatedFrameSource source;

  explicit Bench(std::vector<CameraFaultPeriod> faults, std::uint32_t buffers = 4)
      : source(clock, pictures,
               {.start = kStart, .readout = 6ms, .buffers = buffers, .faults = std::move(faults)}) {
    EXPECT_TRUE(source.start());
  }
  Result<FrameBuffer, PortFault> next() {
    source.wait(clock.now() + 200ms);
    auto frame = source.take();
    if (frame) source.give_back(frame->index);
    return frame;
  }
};

int picture_in(const FrameBuffer& frame) {
  return std::to_integer<int>(frame.image.planes[0].data[0]);
}

/// The fault during frames 2 and 3: exposures begin at 42 and 62 ms.
std::vector<CameraFaultPeriod> fault(CameraFault kind, Nanos amount = 0ns) {
  return {{.fault = kind, .from = 40ms, .until = 80ms, .amount = amount}};
}

TEST(SimulatedFrameSource, FillsABufferWhenTheReadoutIsOverAndStampsTheEndOfTheExposure) {
  Bench bench({});
  EXPECT_EQ(bench.source.next_event(), kStart + 16ms);
  const auto frame = bench.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(bench.clock.now(), kStart + 16ms);
  EXPECT_EQ(frame->stamp, kStart + 10ms);
  EXPECT_EQ(frame->exposure, 8ms);
  EXPECT_EQ(bench.source.next_event(), kStart + 36ms);
}

TEST(SimulatedFrameSource, StampsTheStartOfTheExposureWhereToldSo) {
  SimulatedClock clock;
  const MemoryPictures pictures = counted_pictures();
  SimulatedFrameSource source(clock, pictures, {.start = kStart, .stamp_at = StampAt::exposure_start});
  ASSERT_TRUE(source.start());
  source.wait(kStart + 1s);
  EXPECT_EQ(source.take()->stamp, kStart + 2ms);
}

TEST(SimulatedFrameSource, ShowsEachFrameItsOwnPicture) {
  Bench bench({});
  for (int k = 0; k < 100; ++k) {
    const auto frame = bench.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(picture_in(*frame), k);
  }
  EXPECT_EQ(bench.next().error(), PortFault::nothing_yet) << "after the last picture there is none";
}

TEST(SimulatedFrameSource, StandsStillWhileItIsOff) {
  Bench bench(fault(CameraFault::off));
  for (int k : {0, 1, 4, 5}) EXPECT_EQ(picture_in(*bench.next()), k);
  EXPECT_EQ(bench.next()->sequence, 4U) << "frames that never were are not counted";
}

TEST(SimulatedFrameSource, LeavesAGapForDroppedFrames) {
  Bench bench(fault(CameraFault::dropped));
  for (std::uint32_t sequence : {0U, 1U, 4U, 5U}) EXPECT_EQ(bench.next()->sequence, sequence);
}

TEST(SimulatedFrameSource, RepeatsAPictureWhileItIsStuckThoughTheSequenceAdvances) {
  Bench bench(fault(CameraFault::stuck));
  for (int picture : {0, 1, 2, 2, 4}) EXPECT_EQ(picture_in(*bench.next()), picture);
  EXPECT_EQ(bench.next()->sequence, 5U);
}

TEST(SimulatedFrameSource, FillsPicturesWithNonsense) {
  Bench bench(fault(CameraFault::garbage));
  (void)bench.next();
  (void)bench.next();
  const auto frame = bench.next();
  const std::set<std::byte> values(frame->image.planes[0].data, frame->image.planes[0].data + 8);
  EXPECT_GT(values.size(), 4U);
  (void)bench.next();
  EXPECT_EQ(picture_in(*bench.next()), 4) << "and is well again afterwards";
}

TEST(SimulatedFrameSource, DelaysFramesWithoutMovingTheirStamps) {
  Bench bench(fault(CameraFault::delayed, 50ms));
  (void)bench.next();
  (void)bench.next();
  const auto frame = bench.next();
  EXPECT_EQ(bench.clock.now(), kStart + 106ms);
  EXPECT_EQ(frame->stamp, kStart + 50ms);
}

TEST(SimulatedFrameSource, StampsFramesAheadOfTime) {
  Bench bench(fault(CameraFault::future_stamp, 30ms));
  (void)bench.next();
  (void)bench.next();
  EXPECT_EQ(bench.next()->stamp, kStart + 80ms);
}

TEST(SimulatedFrameSource, MarksDamagedFramesAndKeepsTheirBuffers) {
  Bench bench(fault(CameraFault::damaged), 1);
  (void)bench.next();
  (void)bench.next();
  EXPECT_EQ(bench.next().error(), PortFault::damaged);
  EXPECT_EQ(bench.next().error(), PortFault::damaged);
  EXPECT_EQ(bench.next()->sequence, 4U);
}

TEST(SimulatedFrameSource, FailsTransfersUntilItIsStartedAgainAfterTheFault) {
  Bench bench(fault(CameraFault::io));
  (void)bench.next();
  (void)bench.next();
  EXPECT_EQ(bench.next().error(), PortFault::io);
  EXPECT_EQ(bench.clock.now(), kStart + 40ms) << "a waiting thread is woken for the fault";
  bench.source.stop();
  EXPECT_EQ(bench.source.start().error(), PortFault::io);
  bench.clock.advance_to(kStart + 80ms);
  EXPECT_TRUE(bench.source.start());
  EXPECT_EQ(picture_in(*bench.next()), 4);
}

TEST(SimulatedFrameSource, SaysDisconnectedOnceItIsGone) {
  Bench bench(fault(CameraFault::disconnected));
  (void)bench.next();
  (void)bench.next();
  EXPECT_EQ(bench.next().error(), PortFault::disconnected);
  EXPECT_EQ(bench.next().error(), PortFault::disconnected);
}

TEST(SimulatedFrameSource, CallsAFrameDamagedThatTheStoreCannotRead) {
  SimulatedClock clock;
  const MemoryPictures nothing({.width_px = 4, .height_px = 2, .format = PixelFormat::gray8, .rate_hz = 50},
                               kTiming, 100, {});
  SimulatedFrameSource source(clock, nothing, {.start = kStart});
  ASSERT_TRUE(source.start());
  source.wait(kStart + 1s);
  EXPECT_EQ(source.take().error(), PortFault::damaged);
}

TEST(SimulatedFrameSource, AllocatesNothingWhileItRuns) {
  Bench bench({});
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (int i = 0; i < 10; ++i) (void)bench.next();
  }));
}

}  // namespace

namespace testing {
INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, FrameSourceContract, SimulatedFrameSourceRig);
}
}  // namespace orcart
