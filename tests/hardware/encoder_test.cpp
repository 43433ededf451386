// The rotary encoder on the kernel's own evdev: the seam's contract, a queue that overflows, a knob that is
// pulled out and put back. Knobs are made by uinput, or are two lines of gpio-sim under the driver
// rotary-encoder.
#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>

#include "board/linux/encoder/evdev_encoder.hpp"
#include "tests/board/ports/encoder_contract.hpp"
#include "tests/hardware/environment.hpp"
#include "tests/hardware/made_input.hpp"

namespace orcart::testing {
namespace {

MadeInput made_knob(const std::string& uinput) {
  return MadeInput(uinput, "orcart test knob", [](int fd) {
    ::ioctl(fd, UI_SET_EVBIT, EV_REL);
    ::ioctl(fd, UI_SET_RELBIT, REL_DIAL);
  });
}

/// 1,024 counts a turn, standing at 1,000.
MadeInput made_absolute(const std::string& uinput) {
  return MadeInput(uinput, "orcart test absolute encoder", [](int fd) {
    ::ioctl(fd, UI_SET_EVBIT, EV_ABS);
    uinput_abs_setup axis{.code = ABS_WHEEL, .absinfo = {.value = 1000, .maximum = 1023}};
    ::ioctl(fd, UI_ABS_SETUP, &axis);
  });
}

class UinputRig : public EncoderRig {
 public:
  UinputRig() {
    const auto uinput = device_named("ORCART_TEST_UINPUT");
    if (uinput) knob_.emplace(made_knob(*uinput));
  }
  ~UinputRig() override {
    if (turner_.joinable()) turner_.join();
  }
  std::string missing() const override { return knob_ ? "" : not_set("ORCART_TEST_UINPUT"); }
  Clock& clock() override { return clock_; }
  void schedule(const std::vector<StepAfter>& steps) override {
    const Instant start = clock_.now();
    auto opened = EvdevEncoder::open({.device = knob_->node()}, clock_);
    ASSERT_TRUE(opened) << opened.error().message;
    encoder_ = std::move(*opened);
    turner_ = std::thread([this, steps, start] {
      RealClock clock;
      for (const StepAfter& step : steps) {
        clock.sleep_until(start + step.after);
        knob_->event(EV_REL, REL_DIAL, step.counts);
      }
    });
  }
  TurnEncoder& encoder() override { return *encoder_; }
  Nanos tolerance() const override { return 100ms; }  // a virtual machine's

 private:
  RealClock clock_;
  std::optional<MadeInput> knob_;
  std::unique_ptr<EvdevEncoder> encoder_;
  std::thread turner_;
};

class Encoder : public ::testing::Test {
 protected:
  void SetUp() override {
    uinput = device_named("ORCART_TEST_UINPUT");
    if (!uinput) GTEST_SKIP() << not_set("ORCART_TEST_UINPUT");
  }
  std::unique_ptr<EvdevEncoder> opened(const std::string& device, const std::string& axis = "rel_dial") {
    auto made = EvdevEncoder::open({.device = device, .axis = axis}, clock);
    EXPECT_TRUE(made) << made.error().message;
    return made ? std::move(*made) : nullptr;
  }
  /// The newest reading that is there.
  static std::optional<EncoderReading> newest(EvdevEncoder& encoder) {
    std::optional<EncoderReading> last;
    while (auto reading = encoder.take_reading()) last = *reading;
    return last;
  }

  std::optional<std::string> uinput;
  RealClock clock;
};

TEST_F(Encoder, LosesNoneOfTenThousandStepsThatAreTakenInTime) {
  const MadeInput knob = made_knob(*uinput);
  const auto encoder = opened(knob.node());
  ASSERT_TRUE(encoder);
  const auto first = encoder->take_reading();
  ASSERT_TRUE(first);
  std::optional<EncoderReading> last;
  for (int i = 0; i < 10'000; ++i) {
    knob.event(EV_REL, REL_DIAL, 1);
    if (i % 5 == 4) last = newest(*encoder);
  }
  ASSERT_TRUE(last);
  EXPECT_EQ(last->counts - first->counts, 10'000);
  EXPECT_EQ(last->run, first->run);
}

TEST_F(Encoder, BeginsANewRunWhereTheKernelsQueueOverflowed) {
  const MadeInput knob = made_knob(*uinput);
  const auto encoder = opened(knob.node());
  ASSERT_TRUE(encoder);
  const auto first = encoder->take_reading();
  ASSERT_TRUE(first);
  for (int i = 0; i < 2000; ++i) knob.event(EV_REL, REL_DIAL, 1);
  const auto after = newest(*encoder);
  ASSERT_TRUE(after);
  EXPECT_NE(after->run, first->run);
  knob.event(EV_REL, REL_DIAL, 2);
  const auto step = newest(*encoder);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->run, after->run);
  EXPECT_EQ(step->counts - after->counts, 2);
}

TEST_F(Encoder, AsksAnAbsoluteOneWhereItStandsAlsoAfterItsQueueOverflowed) {
  const MadeInput knob = made_absolute(*uinput);
  const auto encoder = opened(knob.node(), "abs_wheel");
  ASSERT_TRUE(encoder);
  EXPECT_EQ(encoder->take_reading()->counts, 1000);
  for (int i = 0; i < 2000; ++i) knob.event(EV_ABS, ABS_WHEEL, i % 1024);
  EXPECT_EQ(newest(*encoder)->counts, 1999 % 1024);
}

TEST_F(Encoder, IsHeldForOneProgramAloneAndClosesEverythingItOpened) {
  const MadeInput knob = made_knob(*uinput);
  const auto before = open_descriptors();
  {
    const auto encoder = opened(knob.node());
    const auto second = EvdevEncoder::open({.device = knob.node()}, clock);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("in use"), std::string::npos) << second.error().message;
    const auto no_axis = EvdevEncoder::open({.device = knob.node(), .axis = "rel_x"}, clock);
    ASSERT_FALSE(no_axis);
    EXPECT_NE(no_axis.error().message.find("rel_dial would be accepted"), std::string::npos)
        << no_axis.error().message;
  }
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(Encoder, IsNoticedWhenPulledOutAndFoundAgainUnderItsNameWithANewRun) {
  std::optional<MadeInput> knob(made_knob(*uinput));
  // A name that stays, as udev makes one below /dev/input/by-id.
  const std::string name = "/dev/input/orcart-test-knob";
  const auto tie = [&] {
    std::filesystem::remove(name);
    std::filesystem::create_symlink(knob->node(), name);
  };
  tie();
  const auto encoder = opened(name);
  ASSERT_TRUE(encoder);
  const auto first = encoder->take_reading();
  ASSERT_TRUE(first);
  const auto wait_for = [&](auto holds) {
    const Instant end = clock.now() + 5s;
    auto reading = encoder->take_reading();
    while (!holds(reading) && clock.now() < end) {
      clock.sleep_until(clock.now() + 5ms);
      reading = encoder->take_reading();
    }
    return reading;
  };
  knob.reset();
  EXPECT_EQ(wait_for([](const auto& r) { return !r && r.error() == PortFault::disconnected; }).error(),
            PortFault::disconnected);
  knob.emplace(made_knob(*uinput));
  tie();
  const auto back = wait_for([](const auto& r) { return r.has_value(); });
  std::filesystem::remove(name);
  ASSERT_TRUE(back);
  EXPECT_NE(back->run, first->run);
  knob->event(EV_REL, REL_DIAL, 3);
  const auto step = newest(*encoder);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->counts - back->counts, 3);
}

TEST_F(Encoder, IsListed) {
  const MadeInput knob = made_knob(*uinput);
  const auto all = encoders();
  const auto found =
      std::ranges::find_if(all, [&](const EncoderFacts& facts) { return facts.path == knob.node(); });
  ASSERT_NE(found, all.end());
  EXPECT_EQ(found->name, "orcart test knob");
  EXPECT_EQ(found->axes, std::vector<std::string>{"rel_dial"});
}

/// The two contacts of a knob under the kernel's driver rotary-encoder, moved by gpio-sim's pulls.
class PulledKnob {
 public:
  PulledKnob() {
    const auto lines = device_named("ORCART_TEST_ENCODER_LINES"),
               folder = device_named("ORCART_TEST_GPIO_SIM");
    if (!lines || !folder) return;
    const std::size_t colon = lines->find(':');
    for (const std::string& line : {lines->substr(0, colon), lines->substr(colon + 1)})
      pulls_.push_back(*folder + "/sim_gpio" + line + "/pull");
  }
  bool there() const { return !pulls_.empty(); }
  /// One count up or down: one contact opens or closes.
  void step(int way) {
    constexpr std::array<std::array<int, 2>, 4> kGray{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};
    place_ = (place_ + way + 4) % 4;
    for (std::size_t i = 0; i < pulls_.size(); ++i)
      std::ofstream(pulls_[i]) << (kGray[static_cast<std::size_t>(place_)][i] != 0 ? "pull-up" : "pull-down");
  }

 private:
  std::vector<std::string> pulls_;
  int place_ = 0;
};

class RotaryEncoderDriver : public ::testing::Test {
 protected:
  static constexpr const char* kDriver = "/sys/bus/platform/drivers/rotary-encoder/";

  void SetUp() override {
    const auto named = device_named("ORCART_TEST_ENCODER");
    if (!named) GTEST_SKIP() << not_set("ORCART_TEST_ENCODER");
    if (!knob.there()) GTEST_SKIP() << not_set("ORCART_TEST_ENCODER_LINES");
    device = *named;
  }
  void TearDown() override {
    while (at_ != 0) turn(at_ > 0 ? -1 : 1);
  }
  void turn(int way) {
    knob.step(way);
    at_ += way;
  }
  std::unique_ptr<EvdevEncoder> opened(const std::string& node) {
    auto made = EvdevEncoder::open({.device = node}, clock);
    EXPECT_TRUE(made) << made.error().message;
    return made ? std::move(*made) : nullptr;
  }
  /// The next reading; nothing for a second is a failure.
  EncoderReading next(EvdevEncoder& encoder) {
    const Instant end = clock.now() + 1s;
    auto reading = encoder.take_reading();
    while (!reading && clock.now() < end) {
      clock.sleep_until(clock.now() + 1ms);
      reading = encoder.take_reading();
    }
    EXPECT_TRUE(reading) << "no count came";
    return reading ? *reading : EncoderReading{};
  }

  std::string device;
  PulledKnob knob;
  RealClock clock;

 private:
  int at_ = 0;  ///< counts from where it stood; it is left there
};

TEST_F(RotaryEncoderDriver, CountsEachEdgeEitherWayAndStampsIt) {
  const auto encoder = opened(device);
  ASSERT_TRUE(encoder);
  const EncoderReading first = next(*encoder);
  std::int64_t counts = first.counts;
  for (const int way : {1, -1}) {
    for (int i = 0; i < (way > 0 ? 150 : 250); ++i) {
      const Instant before = clock.now();
      turn(way);
      const EncoderReading reading = next(*encoder);
      ASSERT_EQ(reading.counts, counts += way);
      EXPECT_GE(reading.at, before);
      EXPECT_LE(reading.at, clock.now());
      EXPECT_EQ(reading.run, first.run);
    }
  }
}

TEST_F(RotaryEncoderDriver, EndsWhereAContactThatBouncedCameToRest) {
  const auto encoder = opened(device);
  ASSERT_TRUE(encoder);
  const std::int64_t from = next(*encoder).counts;
  turn(1);
  for (int i = 0; i < 15; ++i) {
    turn(-1);
    turn(1);
  }
  std::int64_t last = from;
  for (const Instant end = clock.now() + 500ms; clock.now() < end; clock.sleep_until(clock.now() + 5ms))
    while (const auto reading = encoder->take_reading()) last = reading->counts;
  EXPECT_EQ(last, from + 1);
}

TEST_F(RotaryEncoderDriver, IsListed) {
  const auto all = encoders();
  const auto found = std::ranges::find(all, device, &EncoderFacts::path);
  ASSERT_NE(found, all.end());
  EXPECT_EQ(found->name, "rotary-encoder");
  EXPECT_EQ(found->axes, std::vector<std::string>{"rel_dial"});
}

TEST_F(RotaryEncoderDriver, IsNoticedWhenItLetsGoAndFoundAgainWithANewRun) {
  const std::string name = "/dev/input/orcart-test-rotary";
  const auto tie = [&] {
    std::error_code error;
    std::filesystem::remove(name);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             "/sys/bus/platform/devices/rotary-encoder/input", error))
      if (const auto node = entry.path().filename().string(); node.starts_with("event"))
        std::filesystem::create_symlink("/dev/input/" + node, name);
  };
  tie();
  const auto encoder = opened(name);
  ASSERT_TRUE(encoder);
  const EncoderReading first = next(*encoder);
  std::ofstream(std::string(kDriver) + "unbind") << "rotary-encoder" << std::flush;
  const Instant patience = clock.now() + 5s;
  auto gone = encoder->take_reading();
  while ((gone || gone.error() != PortFault::disconnected) && clock.now() < patience) {
    clock.sleep_until(clock.now() + 5ms);
    gone = encoder->take_reading();
  }
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error(), PortFault::disconnected);
  std::ofstream(std::string(kDriver) + "bind") << "rotary-encoder" << std::flush;
  EncoderReading back;
  for (bool found = false; !found && clock.now() < patience;) {
    tie();
    clock.sleep_until(clock.now() + EvdevEncoder::kRetry);
    if (const auto reading = encoder->take_reading()) back = *reading, found = true;
  }
  std::filesystem::remove(name);
  ASSERT_NE(back.run, first.run);
  turn(1);
  const EncoderReading step = next(*encoder);
  EXPECT_EQ(step.counts - back.counts, 1);
  EXPECT_EQ(step.run, back.run);
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Linux, EncoderContract, UinputRig);

}  // namespace orcart::testing
