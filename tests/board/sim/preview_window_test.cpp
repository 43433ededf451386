// The preview window on a screen in memory: it shows the panel's pictures, and its keys are a pedal.
#include "board/sim/window/preview_window.hpp"

#include <SDL2/SDL.h>
#include <gtest/gtest.h>

#include "board/sim/simulated_gpio.hpp"
#include "board/sim/simulated_panel.hpp"
#include "tests/board/sim/virtual_screen.hpp"

namespace orcart {
namespace {

constexpr PanelMode kMode{.width_px = 320, .height_px = 200, .refresh_hz = 100};

class PreviewWindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!screen_.runs()) GTEST_SKIP() << "Xvfb is not installed (Debian package xvfb)";
    auto opened = PreviewWindow::open(kMode, "orcart test", clock_);
    ASSERT_TRUE(opened) << opened.error().message;
    window_ = std::move(*opened);
  }
  /// Tries until `condition` holds, for 10 s at most.
  template <class Condition>
  bool comes(Condition&& condition) {
    const Instant end = clock_.now() + 10s;
    while (!condition() && clock_.now() < end) clock_.sleep_until(clock_.now() + 5ms);
    return condition();
  }
  static void type(Uint32 kind, SDL_Keycode key) {
    SDL_Event event{};
    event.type = kind;
    event.key.keysym.sym = key;
    SDL_PushEvent(&event);
  }

  testing::VirtualScreen screen_;
  RealClock clock_;
  std::unique_ptr<PreviewWindow> window_;
};

TEST_F(PreviewWindowTest, ShowsWhatThePanelShows) {
  PanelObserver* const observers[] = {window_.get()};
  SimulatedPanel panel(clock_, {.mode = kMode, .first_vblank = clock_.now()}, observers);
  const bool green = comes([&] {
    if (auto image = panel.acquire())
      for (std::size_t i = 0; i < packed_bytes(image->format, image->width_px, image->height_px); i += 4)
        image->planes[0].data[i + 1] = std::byte{200};
    (void)panel.present(clock_.now());
    (void)panel.take_flip(clock_.now());
    return screen_.pixel(320, 240) == std::array{0, 200, 0};  // the window is centred on the screen
  });
  EXPECT_TRUE(green);
  EXPECT_GE(window_->pictures_drawn(), 1U);
}

TEST_F(PreviewWindowTest, TakesTheSpaceBarForThePedal) {
  SimulatedGpio lines(clock_, {}, &window_->pedal());
  type(SDL_KEYDOWN, SDLK_SPACE);
  lines.wait(clock_.now() + 10s);
  const auto edge = lines.take_edge();
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->kind, EdgeKind::pressed);
  type(SDL_KEYUP, SDLK_SPACE);
  lines.wait(clock_.now() + 10s);
  EXPECT_EQ(lines.take_edge()->kind, EdgeKind::released);
}

TEST_F(PreviewWindowTest, AsksToQuitAtTheKeyQ) {
  EXPECT_FALSE(window_->quit_asked());
  type(SDL_KEYDOWN, SDLK_q);
  EXPECT_TRUE(comes([&] { return window_->quit_asked(); }));
}

TEST(PreviewWindow, SaysWhyWhereThereIsNoDisplay) {
  setenv("SDL_VIDEODRIVER", "x11", 1);
  setenv("DISPLAY", ":7654", 1);
  RealClock clock;
  const auto window = PreviewWindow::open(kMode, "orcart test", clock);
  ASSERT_FALSE(window);
  EXPECT_NE(window.error().message.find("no window can be opened here"), std::string::npos);
}

TEST(PreviewWindow, TakesADriverThatShowsNothingForNoDisplay) {
  for (const char* name : {"SDL_VIDEODRIVER", "DISPLAY", "WAYLAND_DISPLAY"}) unsetenv(name);
  RealClock clock;
  const auto window = PreviewWindow::open(kMode, "orcart test", clock);
  ASSERT_FALSE(window);
  EXPECT_NE(window.error().message.find("set DISPLAY"), std::string::npos);
}

}  // namespace
}  // namespace orcart
