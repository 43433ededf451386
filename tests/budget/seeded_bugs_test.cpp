// Each guard catches the bug made for it, and names the place.
#include <gtest/gtest.h>

#include "tests/budget/small_demo.hpp"
#include "tools/guards/thread_guard.hpp"
#include "tools/latency/seed_bugs.hpp"

namespace orcart::testing {
namespace {

struct Expected {
  SeededBug bug;
  const char* place;
};

class SeededBugs : public ::testing::TestWithParam<Expected> {};

TEST_P(SeededBugs, AreCaughtAndNamedWithTheirCallSite) {
  if (!guards::kGuardsWork) GTEST_SKIP() << "sanitizers bring a malloc of their own";
  const auto result = hunt(GetParam().bug, small_demo());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->caught) << result->account;
  EXPECT_NE(result->account.find(GetParam().place), std::string::npos) << result->account;
}

INSTANTIATE_TEST_SUITE_P(
    Each, SeededBugs,
    ::testing::Values(Expected{SeededBug::alloc, "allocate"}, Expected{SeededBug::lock, "lock"},
                      Expected{SeededBug::write, "write_out"}, Expected{SeededBug::fault, "touch_new_page"},
                      Expected{SeededBug::late, "take_too_long"}, Expected{SeededBug::edge, "PedalGestures"}),
    [](const auto& of) { return std::string(name_of(of.param.bug)); });

}  // namespace
}  // namespace orcart::testing
