// What every stage's test says of its step: `EXPECT_TRUE(zero_allocation([&] { stage.step(now); }))`.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hpp"

namespace orcart::testing {

/// Words the verdict on a stretch of code that ran under `scope`, with the first caller where it asked for
/// anything.
::testing::AssertionResult asked_nothing(NoAllocationScope& scope);

/// Runs `step` once on this thread; success where it neither allocates, frees nor locks. Under sanitizers it
/// runs all the same and succeeds. Warm the stage up before: the first step may still be filling caches of
/// libraries.
template <class Step>
::testing::AssertionResult zero_allocation(Step&& step) {
  NoAllocationScope scope;
  step();
  scope.disarm();
  return asked_nothing(scope);
}

}  // namespace orcart::testing
