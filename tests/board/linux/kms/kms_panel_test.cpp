// The real panel's policy over a played card: the seam's contract, a pipe that hangs, a cable that is pulled.
#include "board/linux/kms/kms_panel.hpp"

#include <array>

#include "tests/board/ports/panel_contract.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

/// A card with a 60 Hz pipe on a simulated clock.
class PlayedCard final : public ScanOut {
 public:
  explicit PlayedCard(SimulatedClock& c) : clock(c), pixels(kBuffers * 8 * 4 * 4) {}

  PanelMode mode() const noexcept override { return {.width_px = 8, .height_px = 4, .refresh_hz = 60}; }
  ImageDescriptor buffer(int index) noexcept override {
    return packed_image(pixels.data() + index * 8 * 4 * 4, PixelFormat::xrgb8888, 8, 4);
  }
  void finish_drawing(int index) noexcept override { finished = index; }
  Result<void, PortFault> flip(int index, std::uint64_t serial) noexcept override {
    if (error != PortFault::nothing_yet) return tl::unexpected(error);
    if (pending) return tl::unexpected(PortFault::busy);
    const auto periods = (clock.now() - begin) / period + 1;
    pending = FlipEvent{.serial = serial, .at = begin + periods * period};
    next = index;
    return {};
  }
  std::optional<FlipEvent> next_flip() noexcept override {
    if (!pending || hung || clock.now() < pending->at) return std::nullopt;
    const FlipEvent done = *pending;
    pending.reset();
    shown = next;
    return done;
  }
  Result<void, PortFault> set_mode(int index) noexcept override {
    if (mode_error != PortFault::nothing_yet) return tl::unexpected(mode_error);
    ++modes;
    pending.reset();
    shown = index;
    return {};
  }
  bool connected() noexcept override { return plugged; }

  SimulatedClock& clock;
  const Instant begin = clock.now();
  const Nanos period = period_of(60);
  std::vector<std::byte> pixels;
  std::optional<FlipEvent> pending;
  PortFault error = PortFault::nothing_yet, mode_error = PortFault::nothing_yet;
  bool hung = false, plugged = true;
  int modes = 0, shown = -1, next = -1, finished = -1;
};

struct Bench {
  SimulatedClock clock;
  PlayedCard* card = nullptr;
  std::unique_ptr<KmsPanel> panel;

  Bench() {
    auto played = std::make_unique<PlayedCard>(clock);
    card = played.get();
    auto started = KmsPanel::start(std::move(played), clock);
    EXPECT_TRUE(started);
    panel = std::move(*started);
  }
  Result<std::uint64_t, PortFault> show() {
    if (auto image = panel->acquire(); !image) return tl::unexpected(image.error());
    return panel->present(clock.now());
  }
};

class KmsPanelRig final : public testing::PanelRig {
 public:
  Clock& clock() override { return bench_.clock; }
  Panel& panel() override { return *bench_.panel; }

 private:
  Bench bench_;
};

TEST(KmsPanel, SetsTheModeOnceAndThenOnlyFlips) {
  Bench bench;
  EXPECT_EQ(bench.card->modes, 1);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(bench.show());
    bench.clock.advance_by(17ms);
    ASSERT_TRUE(bench.panel->take_flip(bench.clock.now()));
  }
  EXPECT_EQ(bench.card->modes, 1);
  EXPECT_EQ(bench.card->finished, bench.card->shown);
}

TEST(KmsPanel, SetsTheModeAnewWhenAFlipDoesNotComeAndGoesOn) {
  Bench bench;
  bench.card->hung = true;
  const auto serial = bench.show();
  ASSERT_TRUE(serial);
  bench.clock.advance_by(49ms);
  EXPECT_FALSE(bench.panel->take_flip(bench.clock.now()));
  EXPECT_EQ(bench.card->modes, 1);
  bench.clock.advance_by(2ms);
  const auto flip = bench.panel->take_flip(bench.clock.now());
  ASSERT_TRUE(flip) << "the new mode shows the picture that waited";
  EXPECT_EQ(flip->serial, *serial);
  EXPECT_EQ(bench.card->modes, 2);
  EXPECT_EQ(bench.panel->modes_set_anew(), 1u);
  bench.card->hung = false;
  EXPECT_TRUE(bench.show());
  EXPECT_FALSE(bench.panel->given_up());
}

TEST(KmsPanel, MissesNoFlipThatCameWhileItsSuccessorWasDrawnSlowly) {
  Bench bench;
  const auto serial = bench.show();
  ASSERT_TRUE(serial && bench.panel->acquire());
  bench.clock.advance_by(200ms);
  EXPECT_TRUE(bench.panel->present(bench.clock.now()));
  EXPECT_EQ(bench.panel->modes_set_anew(), 0u);
  const auto flip = bench.panel->take_flip(bench.clock.now());
  ASSERT_TRUE(flip);
  EXPECT_EQ(flip->serial, *serial);
}

TEST(KmsPanel, GivesUpAfterASecondOfAHungPipe) {
  Bench bench;
  bench.card->hung = true;
  bench.card->mode_error = PortFault::io;
  ASSERT_TRUE(bench.show());
  const Instant handed_over = bench.clock.now();
  while (!bench.panel->given_up() && bench.clock.now() < handed_over + 5s) {
    bench.clock.advance_by(10ms);
    (void)bench.panel->take_flip(bench.clock.now());
  }
  EXPECT_GE(bench.clock.now() - handed_over, 1s);
  EXPECT_LE(bench.clock.now() - handed_over, 1s + KmsPanel::kLook + 10ms);
  EXPECT_EQ(bench.show().error(), PortFault::io);
}

TEST(KmsPanel, SaysDisconnectedWhileTheCableIsOutAndShowsAgainWhenItIsBack) {
  Bench bench;
  ASSERT_TRUE(bench.show());
  bench.card->plugged = false;
  bench.clock.advance_by(251ms);
  EXPECT_EQ(bench.show().error(), PortFault::disconnected);
  bench.card->plugged = true;
  bench.clock.advance_by(251ms);
  const int modes = bench.card->modes;
  EXPECT_TRUE(bench.show());
  EXPECT_EQ(bench.card->modes, modes + 1);
  bench.clock.advance_by(17ms);
  EXPECT_TRUE(bench.panel->take_flip(bench.clock.now()));
}

TEST(KmsPanel, IgnoresAFlipOfBeforeANewMode) {
  Bench bench;
  ASSERT_TRUE(bench.show());
  bench.card->hung = true;
  bench.clock.advance_by(60ms);
  ASSERT_TRUE(bench.panel->take_flip(bench.clock.now()));
  bench.card->pending = FlipEvent{.serial = 1, .at = bench.clock.now()};
  bench.card->hung = false;
  EXPECT_FALSE(bench.panel->take_flip(bench.clock.now()));
}

TEST(KmsPanel, HandsOnWhatTheCardRefuses) {
  Bench bench;
  bench.card->error = PortFault::no_permission;
  EXPECT_EQ(bench.show().error(), PortFault::no_permission);
  bench.card->error = PortFault::nothing_yet;
  EXPECT_TRUE(bench.show()) << "what was drawn is kept";
}

TEST(KmsPanel, AllocatesNothingWhileItRuns) {
  Bench bench;
  EXPECT_TRUE(testing::zero_allocation([&] {
    (void)bench.show();
    bench.clock.advance_by(17ms);
    (void)bench.panel->take_flip(bench.clock.now());
    (void)bench.panel->next_vblank(bench.clock.now());
  }));
}

}  // namespace

namespace testing {
INSTANTIATE_TYPED_TEST_SUITE_P(PlayedCard, PanelContract, KmsPanelRig);
}
}  // namespace orcart
