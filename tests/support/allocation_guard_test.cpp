// The guard is proven to bite: a seeded allocation, free or lock is counted and its caller named.
#include "tests/support/allocation_guard.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

class AllocationGuard : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!kAllocationGuardWorks) GTEST_SKIP() << "sanitizers bring a malloc of their own";
  }
};

void* volatile keep;  // so that the compiler cannot drop a pair of new and delete

TEST_F(AllocationGuard, CountsNewAndDelete) {
  NoAllocationScope scope;
  int* const number = new int(1);
  keep = number;
  delete number;
  scope.disarm();
  EXPECT_EQ(scope.counts().allocations, 1u);
  EXPECT_EQ(scope.counts().frees, 1u);
}

TEST_F(AllocationGuard, CountsEveryMemberOfTheMallocFamily) {
  NoAllocationScope scope;
  void* memory[6] = {std::malloc(8), std::calloc(2, 8), std::realloc(nullptr, 8), std::aligned_alloc(64, 64)};
  const int status = posix_memalign(&memory[4], 64, 64);
  memory[5] = operator new (64, std::align_val_t{64});
  for (int i = 0; i < 5; ++i) std::free(memory[i]);
  operator delete (memory[5], std::align_val_t{64});
  scope.disarm();
  EXPECT_EQ(status, 0);
  EXPECT_EQ(scope.counts().allocations, 6u);
  EXPECT_EQ(scope.counts().frees, 6u);
}

TEST_F(AllocationGuard, CountsLocks) {
  std::mutex mutex;
  NoAllocationScope scope;
  mutex.lock();
  mutex.unlock();
  scope.disarm();
  EXPECT_EQ(scope.counts().locks, 1u);
}

TEST_F(AllocationGuard, LooksAtItsOwnThreadOnly) {
  std::vector<int> elsewhere;
  std::atomic<bool> go{false};
  std::atomic<bool> done{false};
  std::thread other([&] {
    while (!go.load()) std::this_thread::yield();
    elsewhere.resize(100);
    done.store(true);
  });
  NoAllocationScope scope;
  go.store(true);
  while (!done.load()) std::this_thread::yield();
  scope.disarm();
  other.join();
  EXPECT_EQ(scope.counts().allocations, 0u);
}

TEST_F(AllocationGuard, FailsAStepWithASeededAllocationAndNamesACaller) {
  const auto verdict = zero_allocation([] { keep = std::make_unique<int>(1).get(); });
  EXPECT_FALSE(verdict);
  EXPECT_NE(std::string(verdict.message()).find("1 allocations, 1 frees"), std::string::npos)
      << verdict.message();
  EXPECT_NE(std::string(verdict.message()).find("allocation_guard_test.cpp"), std::string::npos)
      << verdict.message();
}

TEST_F(AllocationGuard, PassesAStepThatAsksNothing) {
  int total = 0;
  EXPECT_TRUE(zero_allocation([&] { total += 1; }));
  EXPECT_EQ(total, 1);
}

TEST_F(AllocationGuard, RefusesABadAlignmentAsGlibcDoes) {
  void* memory = nullptr;
  EXPECT_EQ(posix_memalign(&memory, 3, 8), EINVAL);
  EXPECT_EQ(memory, nullptr);
}

}  // namespace
}  // namespace orcart::testing
