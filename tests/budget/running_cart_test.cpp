// The guards on every real-time thread of a running cart: what our own code asks once it is warm, and what is
// the driver's.
#include <gtest/gtest.h>

#include "tests/budget/small_demo.hpp"
#include "tools/latency/bench_cart.hpp"
#include "tools/latency/guarded_threads.hpp"

namespace orcart::testing {
namespace {

/// Runs a cart under guard. The captures that were painted in the measured time.
void run_guarded(const CartConfig& config, std::uint64_t& painted) {
  GuardedThreads threads;
  auto made = BenchCart::create({.config = config, .duration_s = 3, .wrapper = &threads});
  ASSERT_TRUE(made) << made.error().message;
  BenchCart& bench = **made;
  ASSERT_TRUE(bench.run([&] { threads.arm(); }, {}));
  EXPECT_TRUE(threads.all_armed());
  for (const std::string& fault : faults_of(threads)) ADD_FAILURE() << fault;
  painted = 0;
  const auto& captures = bench.cart().captures();
  for (std::size_t i = 0; i < captures.size(); ++i)
    painted += captures.at(i).refusal == Refusal::none && captures.at(i).painted_at > bench.measured_from();
  for (const guards::ThreadGuard* guard : threads.guards()) {
    EXPECT_FALSE(guard->system_calls_refused()) << guard->thread();
    EXPECT_GT(guard->steps(), 0u) << guard->thread();
    if (guard->thread() != "render") {
      EXPECT_EQ(guard->unplaced_faults(), 0u) << guard->thread();
    }
  }
  for (const std::string& line : library_lines(threads)) std::printf("  %s\n", line.c_str());
}

TEST(RunningCart, AsksNothingOfHeapLocksKernelOrPagerOnceWarm) {
  if (!guards::kGuardsWork) GTEST_SKIP() << "sanitizers bring a malloc of their own";
  std::uint64_t painted = 0;
  run_guarded(small_demo(), painted);
  EXPECT_GE(painted, 1u);  // how many is the machine's to say
}

TEST(RunningCart, AsksNoMoreWhereItFollowsAScopeThatTurnsByASecondMarker) {
  if (!guards::kGuardsWork) GTEST_SKIP() << "sanitizers bring a malloc of their own";
  std::uint64_t painted = 0;
  run_guarded(small_demo("demo-angled.toml"), painted);
  EXPECT_GE(painted, 1u);
}

TEST(RunningCart, AsksNoMoreWhereItLooksForTheNotchInEveryPicture) {
  if (!guards::kGuardsWork) GTEST_SKIP() << "sanitizers bring a malloc of their own";
  CartConfig config = small_demo("demo-angled.toml");
  config.turn = TurnSource::notch;
  config.tracker.second = false;
  std::uint64_t painted = 0;
  run_guarded(config, painted);
  EXPECT_EQ(painted, 0u) << "its pictures are noise: no notch, no paint";
}

}  // namespace
}  // namespace orcart::testing
