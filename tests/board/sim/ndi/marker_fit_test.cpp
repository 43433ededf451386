// Noise on markers: the fit is the best one, and its orientation noise is what the geometry says.
#include "board/sim/ndi/marker_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "board/sim/ndi/device_clock.hpp"

namespace orcart::testing {
namespace {

using Points = std::vector<Eigen::Vector3d>;

const Points kBody{{0, 0, 0}, {0, 28.59, 41.02}, {0, 0, 88}, {0, -44.32, 40.45}};

TEST(MarkerFit, FindsAKnownMotion) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, -2, 0.5).normalized()));
  Points moved;
  for (const auto& p : kBody) moved.emplace_back(turn * p + Eigen::Vector3d(5, -6, 7));
  const MarkerFit fit = fit_markers(kBody, moved);
  EXPECT_LT(fit.rotation.angularDistance(turn), 1e-9);
  EXPECT_LT((fit.translation_mm - Eigen::Vector3d(5, -6, 7)).norm(), 1e-7);
  EXPECT_LT(fit.error_mm, 1e-7);
}

TEST(MarkerFit, IsAsGoodAsTheClosedFormOnNoisyMarkers) {
  const Points noisy{{0.2, -0.1, 0.3}, {-0.3, 28.4, 41.2}, {0.1, 0.2, 87.8}, {0.1, -44.1, 40.6}};
  Eigen::Matrix3Xd from(3, 4), to(3, 4);
  for (int i = 0; i < 4; ++i) {
    from.col(i) = kBody[static_cast<std::size_t>(i)];
    to.col(i) = noisy[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix4d closed = Eigen::umeyama(from, to, false);
  const MarkerFit fit = fit_markers(kBody, noisy);
  EXPECT_LT((fit.rotation.toRotationMatrix() - closed.topLeftCorner<3, 3>()).norm(), 1e-9);
  EXPECT_LT((fit.translation_mm - closed.topRightCorner<3, 1>()).norm(), 1e-7);
}

TEST(MarkerFit, LeavesTheTurnAboutTheAxisOfCollinearMarkersAlone) {
  const Points line{{0, 0, 0}, {0, 0, 50}, {0, 0, 105}};
  const Points seen{{0.3, 0, 0.1}, {0, -0.3, 50}, {0.1, 0.2, 104.9}};
  const MarkerFit fit = fit_markers(line, seen);
  EXPECT_LT(std::abs(Eigen::AngleAxisd(fit.rotation).axis().z() * Eigen::AngleAxisd(fit.rotation).angle()),
            1e-4);
}

TEST(MarkerNoise, DependsOnSeedToolAndFrameAlone) {
  const MarkerNoise noise{.sigma_mm = 0.2, .seed = 5};
  const auto once = measure_tool(kBody, {}, noise, 1, 77);
  EXPECT_EQ(once.translation_mm, measure_tool(kBody, {}, noise, 1, 77).translation_mm);
  EXPECT_NE(once.translation_mm, measure_tool(kBody, {}, noise, 1, 78).translation_mm);
  EXPECT_NE(once.translation_mm, measure_tool(kBody, {}, noise, 2, 77).translation_mm);
  EXPECT_NE(once.translation_mm, measure_tool(kBody, {}, {.sigma_mm = 0.2, .seed = 6}, 1, 77).translation_mm);
}

TEST(MarkerNoise, SpreadsAsTheMarkersGeometrySays) {
  // Centroid: sigma / sqrt(n) on each axis. Turn about x: sigma / sqrt(sum of squared distances from the x
  // axis through the centroid). Residual RMS: sigma * sqrt((3 n - 6) / n).
  const double sigma = 0.2;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& p : kBody) centre += p / 4.0;
  double inertia = 0;
  for (const auto& p : kBody) inertia += (p - centre).tail<2>().squaredNorm();
  double turn2 = 0, shift2 = 0, rms2 = 0;
  constexpr int kFrames = 20000;
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto fit = measure_tool(kBody, {}, {.sigma_mm = sigma}, 0, static_cast<std::uint32_t>(frame));
    turn2 += std::pow(2 * fit.rotation.x(), 2);
    shift2 += std::pow((fit.rotation * centre + fit.translation_mm - centre).x(), 2);
    rms2 += fit.error_mm * fit.error_mm;
  }
  EXPECT_NEAR(std::sqrt(shift2 / kFrames), sigma / 2, 0.03 * sigma / 2);
  EXPECT_NEAR(std::sqrt(turn2 / kFrames), sigma / std::sqrt(inertia), 0.03 * sigma / std::sqrt(inertia));
  EXPECT_NEAR(std::sqrt(rms2 / kFrames), sigma * std::sqrt(6.0 / 4.0), 0.03 * sigma);
}

TEST(DeviceClock, DriftsAndAgreesWithItself) {
  const DeviceClock clock(instant_from_nanos(0), 3ms, 60, 1000);
  EXPECT_EQ(clock.newest_at(instant_from_nanos(0)), 0u);
  EXPECT_NEAR(seconds(clock.measured_at(60060) - instant_from_nanos(3'000'000)), 1000.0, 1e-6);
  for (std::uint32_t frame : {1u, 7u, 3600u, 1'000'000u}) {
    EXPECT_EQ(clock.newest_at(clock.measured_at(frame)), frame);
    EXPECT_EQ(clock.newest_at(clock.measured_at(frame) - 1ns), frame - 1);
  }
}

}  // namespace
}  // namespace orcart::testing
