// The ledger keeps what fits and counts what does not.
#include "firmware-host/stages/frame_ledger.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(Ledger, KeepsTheFirstRecordsAndCountsTheRest) {
  Ledger<FrameRecord> ledger(2);
  EXPECT_NE(ledger.append({.sequence = 1}), nullptr);
  EXPECT_NE(ledger.append({.sequence = 2}), nullptr);
  EXPECT_EQ(ledger.append({.sequence = 3}), nullptr);
  EXPECT_EQ(ledger.size(), 2u);
  EXPECT_EQ(ledger.at(1).sequence, 2u);
  EXPECT_EQ(ledger.overflow(), 1u);
}

}  // namespace
}  // namespace orcart
