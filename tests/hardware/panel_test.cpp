// The KMS panel on a real display driver: the seam's contract, and that it leaves nothing behind.
#include <cstdio>
#include <iostream>

#include "board/linux/kms/drm_scan_out.hpp"
#include "board/linux/kms/kms_panel.hpp"
#include "tests/board/ports/panel_contract.hpp"
#include "tests/hardware/environment.hpp"

namespace orcart::testing {
namespace {

PanelWish wish_from_environment() {
  PanelWish wish{.device = device_named("ORCART_TEST_PANEL").value_or("")};
  const std::string mode = device_named("ORCART_TEST_PANEL_MODE").value_or("");
  (void)std::sscanf(mode.c_str(), "%dx%d@%lf", &wish.width_px, &wish.height_px, &wish.refresh_hz);
  return wish;
}

Result<std::unique_ptr<KmsPanel>> start(const PanelWish& wish, Clock& clock) {
  auto scan_out = DrmScanOut::open(wish);
  if (!scan_out) return tl::unexpected(scan_out.error());
  if (auto made = (*scan_out)->make_buffers(PanelBuffers::mapped); !made) return tl::unexpected(made.error());
  auto panel = KmsPanel::start(std::move(*scan_out), clock);
  if (!panel) return fail("the mode cannot be set: " + std::string(word_for(panel.error())));
  return std::move(*panel);
}

/// The contract's vblank tests want a driver with real ones: vkms or a cart, not bochs.
class KmsRig : public PanelRig {
 public:
  KmsRig() {
    if (wish_.device.empty()) return;
    auto started = start(wish_, clock_);
    if (started) panel_ = std::move(*started);
    EXPECT_TRUE(started) << (started ? "" : started.error().message);
  }
  std::string missing() const override {
    if (wish_.device.empty()) return not_set("ORCART_TEST_PANEL");
    return panel_ ? "" : "the panel does not open";
  }
  Clock& clock() override { return clock_; }
  Panel& panel() override { return *panel_; }
  Nanos tolerance() const override { return 100ms; }  // a virtual machine's

 private:
  PanelWish wish_ = wish_from_environment();
  RealClock clock_;
  std::unique_ptr<KmsPanel> panel_;
};

class PanelOnACard : public ::testing::Test {
 protected:
  void SetUp() override {
    if (wish.device.empty()) GTEST_SKIP() << not_set("ORCART_TEST_PANEL");
  }
  PanelWish wish = wish_from_environment();
  RealClock clock;
};

TEST_F(PanelOnACard, FlipsSixtyPicturesAndSaysHowFast) {
  auto panel = start(wish, clock);
  ASSERT_TRUE(panel) << panel.error().message;
  Instant first{}, last{};
  int flips = 0;
  const Instant end = clock.now() + 10s;
  while (flips < 60 && clock.now() < end) {
    if ((*panel)->acquire()) (void)(*panel)->present(clock.now());
    clock.sleep_until(clock.now() + 2ms);
    while (const auto flip = (*panel)->take_flip(clock.now())) {
      if (flips++ == 0) first = flip->at;
      EXPECT_GE(flip->at, last);
      last = flip->at;
    }
  }
  ASSERT_GE(flips, 60);
  std::cout << "panel " << (*panel)->mode().width_px << "x" << (*panel)->mode().height_px << " at "
            << (*panel)->mode().refresh_hz << " Hz: " << milliseconds(last - first) / (flips - 1)
            << " ms between flips\n";
}

TEST_F(PanelOnACard, ClosesEverythingItOpened) {
  const auto before = open_descriptors();
  for (int i = 0; i < 3; ++i) {
    const auto panel = start(wish, clock);
    ASSERT_TRUE(panel) << panel.error().message;
  }
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(PanelOnACard, IsRefusedWhileSomebodyElseHoldsTheCard) {
  const auto panel = start(wish, clock);
  ASSERT_TRUE(panel) << panel.error().message;
  const auto second = start(wish, clock);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("held by another program"), std::string::npos)
      << second.error().message;
}

TEST_F(PanelOnACard, ListsItsModesWhereTheWishedOneIsNotThere) {
  wish.width_px = 641;
  wish.height_px = 479;
  const auto panel = start(wish, clock);
  ASSERT_FALSE(panel);
  EXPECT_NE(panel.error().message.find("it has"), std::string::npos) << panel.error().message;
}

TEST_F(PanelOnACard, ShowsATurnedPictureToo) {
  wish.rotation = Rotation::quarter;
  std::swap(wish.width_px, wish.height_px);
  auto panel = start(wish, clock);
  ASSERT_TRUE(panel) << panel.error().message;
  ASSERT_TRUE((*panel)->acquire());
  EXPECT_TRUE((*panel)->present(clock.now()));
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Linux, PanelContract, KmsRig);

}  // namespace orcart::testing
