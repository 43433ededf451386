// What every side of the Panel seam must do, written once and run over each of them.
#pragma once

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "board/ports/panel.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// What a side brings to be tested; default-constructible.
class PanelRig {
 public:
  virtual ~PanelRig() = default;
  /// Why there is nothing to test here, e.g. a device that is absent; empty where there is.
  virtual std::string missing() const { return {}; }
  virtual Clock& clock() = 0;
  virtual Panel& panel() = 0;
  virtual Nanos tolerance() const { return 0ns; }  ///< by which a slow machine may be late for a vblank
};

template <class Rig>
class PanelContract : public ::testing::Test {
 public:
  Rig rig;

  void SetUp() override {
    if (const std::string missing = rig.missing(); !missing.empty()) GTEST_SKIP() << missing;
  }

  Instant now() { return rig.clock().now(); }
  Nanos period() { return period_of(rig.panel().mode().refresh_hz); }
  /// Draws and hands over one picture; its serial, or 0 where the panel refused.
  std::uint64_t show_one() {
    if (!rig.panel().acquire()) return 0;
    return rig.panel().present(now()).value_or(0);
  }
  /// Sleeps from vblank to vblank until a flip can be taken, at most five.
  std::optional<Flip> await_flip() {
    for (int i = 0; i < 5; ++i) {
      rig.clock().sleep_until(rig.panel().next_vblank(now()));
      if (auto flip = rig.panel().take_flip(now())) return flip;
    }
    return std::nullopt;
  }
};

TYPED_TEST_SUITE_P(PanelContract);

TYPED_TEST_P(PanelContract, LendsABufferOfItsModeThatCanBeWritten) {
  const auto image = this->rig.panel().acquire();
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width_px, this->rig.panel().mode().width_px);
  EXPECT_EQ(image->height_px, this->rig.panel().mode().height_px);
  EXPECT_EQ(image->format, PixelFormat::xrgb8888);
  EXPECT_GE(image->planes[0].stride_bytes, 4U * static_cast<unsigned>(image->width_px));
  ASSERT_NE(image->planes[0].data, nullptr);
  image->planes[0].data[0] = std::byte{7};
}

TYPED_TEST_P(PanelContract, LendsTheSameBufferUntilItIsPresented) {
  const auto first = this->rig.panel().acquire(), second = this->rig.panel().acquire();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->planes[0].data, second->planes[0].data);
}

TYPED_TEST_P(PanelContract, RefusesAPresentWithoutABuffer) {
  EXPECT_FALSE(this->rig.panel().present(this->now()));
}

TYPED_TEST_P(PanelContract, FlipsAtTheVblankAfterThePresentAndNamesThePicture) {
  const Instant handed_over = this->now();
  const Instant vblank = this->rig.panel().next_vblank(handed_over);
  const std::uint64_t serial = this->show_one();
  ASSERT_NE(serial, 0U);
  const auto flip = this->await_flip();
  ASSERT_TRUE(flip);
  EXPECT_EQ(flip->serial, serial);
  EXPECT_GE(flip->at, vblank - this->period() / 10);
  EXPECT_LE(flip->at, vblank + this->period() + this->period() / 10 + this->rig.tolerance());
}

TYPED_TEST_P(PanelContract, TellsNoFlipBeforeThereIsOne) {
  EXPECT_FALSE(this->rig.panel().take_flip(this->now()));
  ASSERT_NE(this->show_one(), 0U);
  ASSERT_TRUE(this->await_flip());
  EXPECT_FALSE(this->rig.panel().take_flip(this->now())) << "a flip is told once";
}

TYPED_TEST_P(PanelContract, IsBusyWhileAPictureWaitsAndTakesTheNextAfterItsFlip) {
  ASSERT_NE(this->show_one(), 0U);
  const auto second = this->rig.panel().acquire();
  ASSERT_TRUE(second) << "there is a buffer to draw into while one waits and one is shown";
  const auto refused = this->rig.panel().present(this->now());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), PortFault::busy);
  ASSERT_TRUE(this->await_flip());
  EXPECT_EQ(this->rig.panel().acquire()->planes[0].data, second->planes[0].data)
      << "what was drawn is not lost";
  EXPECT_TRUE(this->rig.panel().present(this->now()));
}

TYPED_TEST_P(PanelContract, CountsPresentsAndNeverLendsWhatIsShown) {
  std::uint64_t last_serial = 0;
  std::byte* shown = nullptr;
  std::set<std::byte*> buffers;
  for (int i = 0; i < 6; ++i) {
    const auto image = this->rig.panel().acquire();
    ASSERT_TRUE(image);
    EXPECT_NE(image->planes[0].data, shown);
    buffers.insert(image->planes[0].data);
    const auto serial = this->rig.panel().present(this->now());
    ASSERT_TRUE(serial);
    EXPECT_EQ(*serial, last_serial + 1);
    last_serial = *serial;
    ASSERT_TRUE(this->await_flip());
    shown = image->planes[0].data;
  }
  EXPECT_GE(buffers.size(), 2U);
}

TYPED_TEST_P(PanelContract, NamesAVblankWithinOnePeriod) {
  for (int i = 0; i < 20; ++i) {
    const Instant now = this->now(), vblank = this->rig.panel().next_vblank(now);
    EXPECT_GT(vblank, now);
    EXPECT_LE(vblank, now + this->period() + 1us);
    this->rig.clock().sleep_until(now + this->period() / 7);
  }
}

TYPED_TEST_P(PanelContract, NamesTheVblankThatAPictureMissed) {
  ASSERT_NE(this->show_one(), 0U);
  const auto flip = this->await_flip();
  ASSERT_TRUE(flip);
  for (int missed = 1; missed < 4; ++missed) {
    const Instant due = flip->at - missed * this->period() - this->period() / 2;
    const Instant vblank = this->rig.panel().next_vblank(due);
    EXPECT_GT(vblank, due) << missed;
    EXPECT_LE(vblank, due + this->period() + 1us) << missed;
  }
}

REGISTER_TYPED_TEST_SUITE_P(PanelContract, LendsABufferOfItsModeThatCanBeWritten,
                            LendsTheSameBufferUntilItIsPresented, RefusesAPresentWithoutABuffer,
                            FlipsAtTheVblankAfterThePresentAndNamesThePicture, TellsNoFlipBeforeThereIsOne,
                            IsBusyWhileAPictureWaitsAndTakesTheNextAfterItsFlip,
                            CountsPresentsAndNeverLendsWhatIsShown, NamesAVblankWithinOnePeriod,
                            NamesTheVblankThatAPictureMissed);

}  // namespace orcart::testing
