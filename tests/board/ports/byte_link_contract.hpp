// What every side of the ByteLink seam must do, written once and run over each of them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "board/ports/byte_link.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// What a side brings to be tested: default-constructible, with a device behind it that answers INIT with
/// OKAY.
class ByteLinkRig {
 public:
  virtual ~ByteLinkRig() = default;
  virtual Clock& clock() = 0;
  virtual ByteLink& link() = 0;
  /// The other side goes away, as a cable that is pulled.
  virtual void cut() = 0;
  /// The other side is there again; false where that cannot be under the same name.
  virtual bool mend() = 0;
};

template <class Rig>
class ByteLinkContract : public ::testing::Test {
 public:
  static constexpr std::string_view kQuestion = "INIT:E3A5\r";
  static constexpr std::string_view kAnswer = "OKAYA896\r";

  Rig rig;

  Result<void, PortFault> ask() {
    return rig.link().write(std::as_bytes(std::span{kQuestion.data(), kQuestion.size()}));
  }
  /// Reads `at_a_time` bytes until `count` have come or a second is over.
  std::string take(std::size_t count, std::size_t at_a_time = 64) {
    std::string text;
    const Instant end = rig.clock().now() + 1s;
    while (text.size() < count && rig.clock().now() < end) {
      rig.link().wait(end);
      std::string piece(at_a_time, '\0');
      const auto got = rig.link().read(std::as_writable_bytes(std::span{piece}));
      if (!got) break;
      text += piece.substr(0, *got);
    }
    return text;
  }
  PortFault fault_within_a_second() {
    const Instant end = rig.clock().now() + 1s;
    std::array<std::byte, 64> sink{};
    while (rig.clock().now() < end) {
      rig.link().wait(end);
      const auto got = rig.link().read(sink);
      if (!got) return got.error();
    }
    return PortFault::nothing_yet;
  }
};

TYPED_TEST_SUITE_P(ByteLinkContract);

TYPED_TEST_P(ByteLinkContract, HasNothingToReadBeforeAnythingWasAsked) {
  std::array<std::byte, 8> into{};
  const auto got = this->rig.link().read(into);
  ASSERT_TRUE(got);
  EXPECT_EQ(*got, 0u);
}

TYPED_TEST_P(ByteLinkContract, CarriesAQuestionAndItsAnswerAndStampsIt) {
  const Instant asked_at = this->rig.clock().now();
  ASSERT_TRUE(this->ask());
  EXPECT_EQ(this->take(this->kAnswer.size()), this->kAnswer);
  EXPECT_GT(this->rig.link().last_arrival(), asked_at);
  EXPECT_LE(this->rig.link().last_arrival(), this->rig.clock().now());
}

TYPED_TEST_P(ByteLinkContract, KeepsWhatDoesNotFit) {
  ASSERT_TRUE(this->ask());
  EXPECT_EQ(this->take(this->kAnswer.size(), 1), this->kAnswer);
}

TYPED_TEST_P(ByteLinkContract, DropsWhatWasNotRead) {
  ASSERT_TRUE(this->ask());
  EXPECT_EQ(this->take(2, 2).size(), 2u);
  this->rig.link().wait(this->rig.clock().now() + 1s);
  this->rig.clock().sleep_until(this->rig.clock().now() + 30ms);
  this->rig.link().discard_input();
  std::array<std::byte, 8> into{};
  EXPECT_EQ(this->rig.link().read(into).value_or(99), 0u);
}

TYPED_TEST_P(ByteLinkContract, WaitsNoLongerThanItWasTold) {
  const Instant deadline = this->rig.clock().now() + 5ms;
  this->rig.link().wait(deadline);
  EXPECT_GE(this->rig.clock().now(), deadline - 1ms);
  this->rig.link().wait(deadline - 1s);
}

TYPED_TEST_P(ByteLinkContract, SaysThatTheOtherSideIsGoneAndThenSleeps) {
  this->rig.cut();
  EXPECT_EQ(this->fault_within_a_second(), PortFault::disconnected);
  EXPECT_FALSE(this->ask());
  const Instant deadline = this->rig.clock().now() + 5ms;
  this->rig.link().wait(deadline);
  EXPECT_GE(this->rig.clock().now(), deadline) << "a dead link must not spin";
}

TYPED_TEST_P(ByteLinkContract, OpensAgainOnceTheOtherSideIsBack) {
  this->rig.cut();
  EXPECT_EQ(this->fault_within_a_second(), PortFault::disconnected);
  EXPECT_FALSE(this->rig.link().reopen());
  if (!this->rig.mend()) return;
  ASSERT_TRUE(this->rig.link().reopen());
  ASSERT_TRUE(this->ask());
  EXPECT_EQ(this->take(this->kAnswer.size()), this->kAnswer);
}

REGISTER_TYPED_TEST_SUITE_P(ByteLinkContract, HasNothingToReadBeforeAnythingWasAsked,
                            CarriesAQuestionAndItsAnswerAndStampsIt, KeepsWhatDoesNotFit, DropsWhatWasNotRead,
                            WaitsNoLongerThanItWasTold, SaysThatTheOtherSideIsGoneAndThenSleeps,
                            OpensAgainOnceTheOtherSideIsBack);

}  // namespace orcart::testing
