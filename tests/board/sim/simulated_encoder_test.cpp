// The simulated turn encoder: the seam's contract, an unplugged one, lost steps.
#include "board/sim/simulated_encoder.hpp"

#include <memory>

#include "tests/board/ports/encoder_contract.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

class SimulatedEncoderRig final : public testing::EncoderRig {
 public:
  Clock& clock() override { return clock_; }
  void schedule(const std::vector<testing::StepAfter>& steps) override {
    EncoderScript script;
    std::int64_t counts = 0;
    for (const auto& step : steps)
      script.steps.push_back({.at = clock_.now() + step.after, .counts = counts += step.counts});
    encoder_ = std::make_unique<SimulatedEncoder>(clock_, script);
  }
  TurnEncoder& encoder() override { return *encoder_; }

 private:
  SimulatedClock clock_;
  std::unique_ptr<SimulatedEncoder> encoder_;
};

const Instant kStart = SimulatedClock().now();
const std::vector<EncoderStep> kThreeSteps{{.at = kStart + 10ms, .counts = 1},
                                           {.at = kStart + 20ms, .counts = 2},
                                           {.at = kStart + 30ms, .counts = 3}};

TEST(SimulatedEncoder, IsGoneForAWhileAndKnowsNothingOfWhatWasTurnedMeanwhile) {
  SimulatedClock clock;
  SimulatedEncoder encoder(clock, {.steps = kThreeSteps, .gone_at = kStart + 15ms, .back_at = kStart + 25ms});
  const std::uint32_t run = encoder.take_reading()->run;
  clock.advance_to(kStart + 12ms);
  EXPECT_EQ(encoder.take_reading()->counts, 1);
  clock.advance_to(kStart + 20ms);
  EXPECT_EQ(encoder.take_reading().error(), PortFault::disconnected);
  clock.advance_to(kStart + 40ms);
  const auto back = encoder.take_reading(), step = encoder.take_reading();
  ASSERT_TRUE(back && step);
  EXPECT_NE(back->run, run);
  EXPECT_EQ(back->at, kStart + 25ms);
  EXPECT_EQ(step->counts - back->counts, 1);
  EXPECT_EQ(step->at, kStart + 30ms);
}

TEST(SimulatedEncoder, BeginsANewRunWhereItsQueueOverflowed) {
  SimulatedClock clock;
  SimulatedEncoder encoder(clock, {.steps = kThreeSteps, .lost_at = kStart + 25ms});
  const std::uint32_t run = encoder.take_reading()->run;
  clock.advance_to(kStart + 40ms);
  const auto again = encoder.take_reading(), step = encoder.take_reading();
  ASSERT_TRUE(again && step);
  EXPECT_NE(again->run, run);
  EXPECT_EQ(step->counts - again->counts, 1);
}

TEST(SimulatedEncoder, AllocatesNothing) {
  SimulatedClock clock;
  SimulatedEncoder encoder(clock, {.steps = kThreeSteps});
  clock.advance_to(kStart + 40ms);
  EXPECT_TRUE(testing::zero_allocation([&] {
    while (encoder.take_reading()) {
    }
  }));
}

}  // namespace

namespace testing {
INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, EncoderContract, SimulatedEncoderRig);
}
}  // namespace orcart
