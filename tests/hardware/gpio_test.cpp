// The pedal on real drivers: the seam's contract and lost edges on gpio-sim, and a keyboard pedal on uinput.
#include <sys/ioctl.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "board/linux/pedal/gpio_pedal.hpp"
#include "board/linux/pedal/keyboard_pedal.hpp"
#include "tests/board/ports/gpio_contract.hpp"
#include "tests/hardware/environment.hpp"
#include "tests/hardware/made_input.hpp"

namespace orcart::testing {
namespace {

/// CHIP:LINE[:TRIGGER]; empty where it cannot be read.
std::optional<GpioWish> gpio_from_environment() {
  const auto named = device_named("ORCART_TEST_GPIO");
  if (!named) return std::nullopt;
  const auto first = named->find(':'), second = named->find(':', first + 1);
  if (first == std::string::npos) return std::nullopt;
  GpioWish wish{.chip = named->substr(0, first), .line = named->substr(first + 1, second - first - 1)};
  if (second != std::string::npos) wish.trigger_line = named->substr(second + 1);
  return wish;
}

/// Moves the pedal's line from outside, as a foot would.
class SimulatedFoot {
 public:
  SimulatedFoot() {
    const auto folder = device_named("ORCART_TEST_GPIO_SIM");
    const auto wish = gpio_from_environment();
    if (folder && wish) file_ = *folder + "/sim_gpio" + wish->line + "/pull";
  }
  bool there() const { return std::filesystem::exists(file_); }
  void press() const { write("pull-up"); }
  void release() const { write("pull-down"); }

 private:
  void write(const char* level) const { std::ofstream(file_) << level << std::flush; }
  std::string file_;
};

class GpioSimRig : public GpioRig {
 public:
  GpioSimRig() {
    if (!missing().empty()) return;
    foot_.release();
    auto opened = GpioPedal::open(*wish_, clock_);
    if (opened) lines_ = std::move(*opened);
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  }
  ~GpioSimRig() override {
    if (mover_.joinable()) mover_.join();
  }
  std::string missing() const override {
    if (!wish_) return not_set("ORCART_TEST_GPIO");
    return foot_.there() ? "" : not_set("ORCART_TEST_GPIO_SIM");
  }
  Clock& clock() override { return clock_; }
  void schedule(const std::vector<EdgeAfter>& edges) override {
    const Instant start = clock_.now();
    mover_ = std::thread([this, edges, start] {
      RealClock clock;
      for (const EdgeAfter& edge : edges) {
        clock.sleep_until(start + edge.after);
        if (edge.kind == EdgeKind::pressed) foot_.press();
        if (edge.kind == EdgeKind::released) foot_.release();
      }
    });
  }
  GpioLines& lines() override { return *lines_; }
  Nanos tolerance() const override { return 100ms; }  // a virtual machine's

 private:
  std::optional<GpioWish> wish_ = gpio_from_environment();
  SimulatedFoot foot_;
  RealClock clock_;
  std::unique_ptr<GpioPedal> lines_;
  std::thread mover_;
};

class Gpio : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!wish) GTEST_SKIP() << not_set("ORCART_TEST_GPIO");
    if (!foot.there()) GTEST_SKIP() << not_set("ORCART_TEST_GPIO_SIM");
    foot.release();
    auto opened = GpioPedal::open(*wish, clock);
    ASSERT_TRUE(opened) << opened.error().message;
    pedal = std::move(*opened);
  }

  std::optional<GpioWish> wish = gpio_from_environment();
  SimulatedFoot foot;
  RealClock clock;
  std::unique_ptr<GpioPedal> pedal;
};

TEST_F(Gpio, LosesNoneOfThreeHundredPresses) {
  std::uint32_t last = 0;
  Instant last_at{};
  for (int i = 0; i < 600; ++i) {
    const bool press = i % 2 == 0;
    press ? foot.press() : foot.release();
    const Instant end = clock.now() + 5s;
    auto edge = pedal->take_edge();
    while (!edge && clock.now() < end) {
      pedal->wait(end);
      edge = pedal->take_edge();
    }
    ASSERT_TRUE(edge) << "edge " << i << " did not come";
    EXPECT_EQ(edge->kind, press ? EdgeKind::pressed : EdgeKind::released);
    EXPECT_EQ(edge->sequence, last + 1);
    EXPECT_GT(edge->at, last_at);
    last = edge->sequence;
    last_at = edge->at;
  }
}

TEST_F(Gpio, ShowsAGapForEveryEdgeThatAFastBurstLoses) {
  for (int i = 0; i < 200; ++i) {
    foot.press();
    foot.release();
  }
  std::vector<PedalEdge> edges;
  const Instant end = clock.now() + 2s;
  while (clock.now() < end) {
    pedal->wait(clock.now() + 50ms);
    while (auto edge = pedal->take_edge()) edges.push_back(*edge);
  }
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const bool alike = edges[i].kind == edges[i - 1].kind;
    EXPECT_EQ(edges[i].sequence - edges[i - 1].sequence > 1, alike) << i;
  }
  std::cout << "of 400 edges within microseconds " << edges.size() << " came\n";
}

TEST_F(Gpio, SaysWhoHoldsALineThatIsTaken) {
  const auto second = GpioPedal::open(*wish, clock);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("in use"), std::string::npos) << second.error().message;
}

TEST_F(Gpio, ClosesEverythingItOpened) {
  pedal.reset();
  const auto before = open_descriptors();
  for (int i = 0; i < 3; ++i) {
    auto again = GpioPedal::open(*wish, clock);
    ASSERT_TRUE(again) << again.error().message;
  }
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(Gpio, RaisesTheTriggerForItsWidth) {
  if (wish->trigger_line.empty()) GTEST_SKIP() << "ORCART_TEST_GPIO names no trigger line";
  const std::string value =
      *device_named("ORCART_TEST_GPIO_SIM") + "/sim_gpio" + wish->trigger_line + "/value";
  const auto level = [&] {
    int read = -1;
    std::ifstream(value) >> read;
    return read;
  };
  const Instant began = clock.now();
  ASSERT_TRUE(pedal->pulse_trigger(began, 300ms));
  EXPECT_EQ(level(), 1);
  pedal->wait(began + 150ms);
  EXPECT_EQ(level(), 1);
  pedal->wait(began + 400ms);
  EXPECT_EQ(level(), 0);
}

/// A keyboard with one key.
MadeInput made_keyboard(const std::string& uinput) {
  return MadeInput(uinput, "orcart test pedal", [](int fd) {
    ::ioctl(fd, UI_SET_EVBIT, EV_KEY);
    ::ioctl(fd, UI_SET_KEYBIT, KEY_F13);
  });
}

TEST(Keyboard, IsAPedalThatIsGrabbedAndComesBack) {
  const auto uinput = device_named("ORCART_TEST_UINPUT");
  if (!uinput) GTEST_SKIP() << not_set("ORCART_TEST_UINPUT");
  RealClock clock;
  auto keyboard = std::make_optional(made_keyboard(*uinput));
  auto pedal = KeyboardPedal::open({.device = keyboard->node(), .key = "f13"}, clock);
  ASSERT_TRUE(pedal) << pedal.error().message;
  EXPECT_FALSE(KeyboardPedal::open({.device = keyboard->node(), .key = "f13"}, clock)) << "it is grabbed";

  const Instant before = clock.now();
  keyboard->event(EV_KEY, KEY_F13, 1);
  (*pedal)->wait(clock.now() + 1s);
  const auto edge = (*pedal)->take_edge();
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->kind, EdgeKind::pressed);
  EXPECT_GE(edge->at, before);
  EXPECT_LE(edge->at, clock.now());

  keyboard.reset();
  (*pedal)->wait(clock.now() + 1s);
  auto gone = (*pedal)->take_edge();
  for (int i = 0; i < 8 && gone; ++i) gone = (*pedal)->take_edge();
  EXPECT_EQ(gone.error(), PortFault::disconnected);
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Linux, GpioContract, GpioSimRig);

std::string first_line_of(const std::string& file) {
  std::string line;
  std::getline(std::ifstream(file) >> std::ws, line);
  return line;
}

/// ORCART_TEST_GPIO_CONFIG is the chip's folder in gpio-sim's configfs. The last test: the chip may come back
/// under another number.
TEST(GpioChip, IsUsedAgainAfterItWasRemovedAndPutBack) {
  const auto config = device_named("ORCART_TEST_GPIO_CONFIG");
  if (!config) GTEST_SKIP() << not_set("ORCART_TEST_GPIO_CONFIG");
  RealClock clock;
  auto pedal = GpioPedal::open({.chip = "cart", .line = "pedal"}, clock);
  ASSERT_TRUE(pedal) << pedal.error().message;
  const auto waits_for = [&](PortFault wanted) {
    const Instant end = clock.now() + 5s;
    auto edge = (*pedal)->take_edge();
    while ((edge || edge.error() != wanted) && clock.now() < end) {
      (*pedal)->wait(clock.now() + 20ms);
      edge = (*pedal)->take_edge();
    }
    return !edge && edge.error() == wanted;
  };
  std::ofstream(*config + "/live") << 0 << std::flush;
  EXPECT_TRUE(waits_for(PortFault::disconnected));
  std::ofstream(*config + "/live") << 1 << std::flush;
  ASSERT_TRUE(waits_for(PortFault::nothing_yet));
  std::ofstream("/sys/devices/platform/" + first_line_of(*config + "/dev_name") + "/" +
                first_line_of(*config + "/bank0/chip_name") + "/sim_gpio4/pull")
      << "pull-up" << std::flush;
  (*pedal)->wait(clock.now() + 5s);
  const auto edge = (*pedal)->take_edge();
  ASSERT_TRUE(edge) << word_for(edge.error());
  EXPECT_EQ(edge->kind, EdgeKind::pressed);
}

}  // namespace orcart::testing
