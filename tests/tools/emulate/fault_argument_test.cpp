// Faults as a person types them.
#include "tools/emulate/fault_argument.hpp"

#include <gtest/gtest.h>

namespace orcart::testing {
namespace {

constexpr Instant kStart = instant_from_nanos(1'000'000'000);

TEST(FaultArgument, IsReadInAllItsParts) {
  const auto fault = parse_fault("late:40@2-5.5/3", kStart);
  ASSERT_TRUE(fault) << fault.error().message;
  EXPECT_EQ(fault->fault, NdiFault::late);
  EXPECT_EQ(fault->amount, 40);
  EXPECT_EQ(fault->from, kStart + 2s);
  EXPECT_EQ(fault->until, kStart + 5500ms);
  EXPECT_EQ(fault->every, 3u);
}

TEST(FaultArgument, HoldsFromTheStartForEverWhereNothingElseIsSaid) {
  const auto fault = parse_fault("bad-crc/50", kStart);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->from, kStart);
  EXPECT_EQ(fault->until, Instant::max());
  EXPECT_EQ(fault->every, 50u);
}

TEST(FaultArgument, IsRefusedWithWhatWouldBeAccepted) {
  for (const char* text :
       {"", "fire", "late:x", "silence@5-2", "silence@-1", "silence/0", "late:40@2-5/x", "@1"}) {
    const auto fault = parse_fault(text, kStart);
    ASSERT_FALSE(fault) << text;
    EXPECT_NE(fault.error().message.find("KIND one of silence"), std::string::npos);
  }
}

}  // namespace
}  // namespace orcart::testing
