// A capture's velocity: as the cart kept it, from its stream, or assumed.
#include "tools/evaluate/session/capture_velocities.hpp"

#include <gtest/gtest.h>

#include "tools/evaluate/error_chain.hpp"

namespace orcart {
namespace {

/// At `ms`, moved on by 30 mm/s along x and 0.2 rad/s about y.
StoredCapture capture(std::uint32_t unit, int ms) {
  StoredCapture made;
  made.facts.unit = unit;
  Twist moved_on;
  moved_on << 1e-3 * ms * 30, 0, 0, 0, 1e-3 * ms * 0.2, 0;
  made.facts.X_MC = moved(Pose<M, C>{}, moved_on);
  made.exposure_start = instant_from_nanos(0) + std::chrono::milliseconds(ms);
  made.exposure_end = made.exposure_start + 8ms;
  return made;
}

TEST(CaptureVelocities, OfAStreamAreTheWayFromTheOneBeforeToTheOneAfter) {
  VelocitySources sources;
  const auto velocities = capture_velocities({capture(1, 0), capture(1, 40), capture(1, 80)}, {}, sources);
  EXPECT_EQ(sources.neighbours, 3U);
  for (const Twist& velocity : velocities) {
    EXPECT_NEAR(velocity.head<3>().norm(), 30, 0.1);
    EXPECT_NEAR(velocity[4], 0.2, 1e-9);
  }
  EXPECT_NEAR(sources.turn_rad_s, 0.2, 1e-9);
}

TEST(CaptureVelocities, OfSinglePressesAreAssumed) {
  VelocitySources sources;
  const ErrorModel model;
  // Another press, and one of the same stream that is too far away in time.
  const auto velocities =
      capture_velocities({capture(1, 0), capture(2, 40), capture(2, 300)}, model, sources);
  EXPECT_EQ(sources.assumed, 3U);
  for (const Twist& velocity : velocities) EXPECT_EQ(velocity, assumed_velocity(model));
}

TEST(CaptureVelocities, AreTheCartsOwnWhereItKeptThem) {
  VelocitySources sources;
  std::vector<StoredCapture> captures{capture(1, 0), capture(1, 40)};
  Twist kept;
  kept << 1, 2, 3, 0.4, 0.5, 0.6;
  captures[1].facts.velocity = kept;
  const auto velocities = capture_velocities(captures, {}, sources);
  EXPECT_EQ(sources.stored, 1U);
  EXPECT_EQ(sources.neighbours, 1U);
  EXPECT_EQ(velocities[1], kept);
}

}  // namespace
}  // namespace orcart
