// The simulated panel: the seam's contract, exact vblanks, its memory of flips, observers and faults.
#include "board/sim/simulated_panel.hpp"

#include "tests/board/ports/panel_contract.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

const Instant kStart = SimulatedClock().now();
const SimulatedPanelSetup kSmall{.mode = {.width_px = 8, .height_px = 4, .refresh_hz = 60},
                                 .first_vblank = kStart + 5ms};

class SimulatedPanelRig final : public testing::PanelRig {
 public:
  Clock& clock() override { return clock_; }
  Panel& panel() override { return panel_; }

 private:
  SimulatedClock clock_;
  SimulatedPanel panel_{clock_, kSmall};
};

/// Fills the drawing buffer with one byte and hands it over; then moves the clock to its flip.
void show(SimulatedPanel& panel, SimulatedClock& clock, int value) {
  const auto image = panel.acquire();
  ASSERT_TRUE(image);
  std::fill_n(image->planes[0].data, packed_bytes(image->format, image->width_px, image->height_px),
              static_cast<std::byte>(value));
  ASSERT_TRUE(panel.present(clock.now()));
  clock.advance_to(panel.next_event());
}

TEST(SimulatedPanel, HasVblanksThatDoNotDriftFromTheRefreshRate) {
  SimulatedClock clock;
  const SimulatedPanel panel(clock, kSmall);
  EXPECT_EQ(panel.next_vblank(kStart), kStart + 5ms);
  EXPECT_EQ(panel.next_vblank(kStart + 5ms), kStart + 5ms + 16'666'667ns);
  EXPECT_EQ(panel.next_vblank(kStart + 5ms + 3599s + 999ms), kStart + 5ms + 3600s) << "after an hour";
  EXPECT_EQ(panel.next_vblank(kStart - 100ms), kStart + 5ms - 100ms);
}

TEST(SimulatedPanel, MissesTheVblankWhenThePresentComesAtIt) {
  SimulatedClock clock;
  SimulatedPanel panel(clock, kSmall);
  clock.advance_to(kStart + 5ms);
  ASSERT_TRUE(panel.acquire());
  ASSERT_TRUE(panel.present(clock.now()));
  EXPECT_EQ(panel.next_event(), kStart + 5ms + 16'666'667ns);
}

TEST(SimulatedPanel, RemembersWhatWasOnThePanelAtAnInstant) {
  SimulatedClock clock;
  SimulatedPanel panel(clock, kSmall);
  show(panel, clock, 1);
  show(panel, clock, 2);
  ASSERT_TRUE(panel.take_flip(clock.now()));
  EXPECT_FALSE(panel.shown_at(kStart + 4ms));
  EXPECT_EQ(panel.shown_at(kStart + 5ms)->serial, 1U);
  EXPECT_EQ(panel.shown_at(kStart + 21ms)->serial, 1U);
  EXPECT_EQ(panel.shown_at(kStart + 22ms)->serial, 2U);
}

TEST(SimulatedPanel, LendsBothPicturesToItsObserversAtAFlip) {
  struct Watcher final : PanelObserver {
    std::vector<int> fresh, old;
    void flipped(const ShownPicture& now, const ShownPicture* before) noexcept override {
      fresh.push_back(std::to_integer<int>(now.image.planes[0].data[0]));
      old.push_back(before == nullptr ? -1 : std::to_integer<int>(before->image.planes[0].data[0]));
    }
  } watcher;
  PanelObserver* const observers[] = {&watcher};
  SimulatedClock clock;
  SimulatedPanel panel(clock, kSmall, observers);
  for (int value : {1, 2, 3, 4}) show(panel, clock, value);
  (void)panel.take_flip(clock.now());
  EXPECT_EQ(watcher.fresh, (std::vector{1, 2, 3, 4}));
  EXPECT_EQ(watcher.old, (std::vector{-1, 1, 2, 3}));
}

TEST(SimulatedPanel, HoldsAFlipBackWhileThePipeIsStuck) {
  SimulatedClock clock;
  SimulatedPanelSetup setup = kSmall;
  setup.faults = {{.fault = PanelFault::flip_stuck, .from = kStart, .until = kStart + 105ms}};
  SimulatedPanel panel(clock, setup);
  ASSERT_TRUE(panel.acquire());
  ASSERT_TRUE(panel.present(clock.now()));
  clock.advance_by(100ms);
  EXPECT_FALSE(panel.take_flip(clock.now()));
  clock.advance_by(10ms);
  EXPECT_EQ(panel.take_flip(clock.now())->at, kStart + 105ms);
}

TEST(SimulatedPanel, SaysDisconnectedWhileItIsUnplugged) {
  SimulatedClock clock;
  SimulatedPanelSetup setup = kSmall;
  setup.faults = {{.fault = PanelFault::disconnected, .from = kStart + 1ms, .until = kStart + 10ms}};
  SimulatedPanel panel(clock, setup);
  ASSERT_TRUE(panel.acquire());
  clock.advance_by(1ms);
  EXPECT_EQ(panel.acquire().error(), PortFault::disconnected);
  EXPECT_EQ(panel.present(clock.now()).error(), PortFault::disconnected);
  clock.advance_by(9ms);
  EXPECT_TRUE(panel.present(clock.now()));
}

TEST(SimulatedPanel, AllocatesNothingWhileItRuns) {
  SimulatedClock clock;
  SimulatedPanel panel(clock, kSmall);
  EXPECT_TRUE(testing::zero_allocation([&] {
    show(panel, clock, 1);
    show(panel, clock, 2);
    (void)panel.take_flip(clock.now());
  }));
}

}  // namespace

namespace testing {
INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, PanelContract, SimulatedPanelRig);
}
}  // namespace orcart
