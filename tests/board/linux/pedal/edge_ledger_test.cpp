// A lost edge leaves a gap, whether the kernel counts or not.
#include "board/linux/pedal/edge_ledger.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

constexpr EdgeKind kDown = EdgeKind::pressed, kUp = EdgeKind::released;

RawEdge raw(EdgeKind kind, std::optional<std::uint32_t> number = std::nullopt) {
  return {.kind = kind, .at = instant_from_nanos(5), .number = number};
}

TEST(EdgeLedger, CountsEdgesThatAlternate) {
  EdgeLedger ledger;
  ledger.found_at(kUp);
  EXPECT_EQ(ledger.accept(raw(kDown)).sequence, 1u);
  EXPECT_EQ(ledger.accept(raw(kUp)).sequence, 2u);
  EXPECT_EQ(ledger.accept(raw(kDown)).sequence, 3u);
}

TEST(EdgeLedger, LeavesAGapWhereTwoEdgesAreAlike) {
  EdgeLedger ledger;
  ledger.found_at(kUp);
  EXPECT_EQ(ledger.accept(raw(kDown)).sequence, 1u);
  EXPECT_EQ(ledger.accept(raw(kDown)).sequence, 3u);
}

TEST(EdgeLedger, SeesThatTheFirstEdgeCannotBeTheFirst) {
  EdgeLedger ledger;
  ledger.found_at(kDown);
  EXPECT_EQ(ledger.accept(raw(kDown)).sequence, 2u);
}

TEST(EdgeLedger, FollowsTheKernelsNumbers) {
  EdgeLedger ledger;
  ledger.found_at(kUp);
  EXPECT_EQ(ledger.accept(raw(kDown, 1)).sequence, 1u);
  EXPECT_EQ(ledger.accept(raw(kUp, 2)).sequence, 2u);
  EXPECT_EQ(ledger.accept(raw(kUp, 4)).sequence, 4u);
  EXPECT_EQ(ledger.accept(raw(kDown, 4)).sequence, 6u) << "a number twice is a loss too";
  EXPECT_EQ(ledger.accept(raw(kUp, 0)).sequence, 8u) << "and so is one that falls back";
}

TEST(EdgeLedger, LeavesAGapWhereTwoNumberedEdgesAreAlike) {
  EdgeLedger ledger;
  ledger.found_at(kUp);
  EXPECT_EQ(ledger.accept(raw(kDown, 1)).sequence, 1u);
  EXPECT_EQ(ledger.accept(raw(kDown, 2)).sequence, 3u);
  EXPECT_EQ(ledger.accept(raw(kUp, 3)).sequence, 4u);
}

TEST(EdgeLedger, ShowsALossThatWasToldToIt) {
  EdgeLedger ledger;
  ledger.found_at(kUp);
  (void)ledger.accept(raw(kDown, 1));
  ledger.lose();
  EXPECT_EQ(ledger.accept(raw(kUp, 2)).sequence, 3u);
  EXPECT_EQ(ledger.accept(raw(kDown, 3)).sequence, 4u);
}

TEST(EdgeLedger, KnowsALossFromTheLevelAtAReopening) {
  EdgeLedger ledger;
  ledger.found_at(kUp);
  (void)ledger.accept(raw(kDown, 7));
  ledger.found_at(kUp);
  EXPECT_EQ(ledger.accept(raw(kDown, 1)).sequence, 3u);
}

}  // namespace
}  // namespace orcart
